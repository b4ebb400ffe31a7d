// SPDX-License-Identifier: MIT
// Definitions of scenes: from what users write to the one definition in the module, and messages about what is wrong.
import { library, memory, text } from "./module.js";
import { check, checkFinite } from "./options.js";

const flags = { editable: 1, noUndo: 2, tensionOnly: 8, heldForces: 16 };
const forceIgnoresVelocity = 4;
const names = [
    ..."axes position velocity mass pinned links weightedLinks gravity drag maxSpeed methods".split(" "),
    ..."force forceUsesVelocity component base colliders count".split(" "),
    ..."particleRadius particleFriction particleMask".split(" "),
    ...Object.keys(flags),
];

export const checkCount = (name, value, least = 0) =>
    check(Number.isSafeInteger(value) && value >= least, name, `an integer >= ${least}`, value);

export function checkUpTo(name, value, most) {
    const good = value >= 0 && value <= most && Number.isInteger(value);
    check(good, name, `an integer from 0 to ${most}`, value);
}

export const checkObject = (name, value) =>
    check(typeof value === "object" && value !== null, name, "an object", value, TypeError);

export function checkKnown(name, options, known) {
    checkObject(name, options);
    for (const option of Object.keys(options))
        if (!known.includes(option)) throw new TypeError(`the option ${option} is unknown`);
}

export function checkArray(name, value, length) {
    check(typeof value === "object" && value?.length >= 0, name, "an array", value, TypeError);
    check(length === undefined || value.length === length, `${name}.length`, `${length}`, value?.length);
}

export function checkNumbers(name, values) {
    for (let i = 0; i < values.length; i++) checkFinite(`${name}[${i}]`, values[i]);
}

/** A vector may omit the axes that a scene does not have. Returns it as an array. */
export function checkVector(name, vector, axes) {
    checkArray(name, vector);
    const { length } = vector;
    check(length === 3 || length === axes, `${name}.length`, `${axes}${axes < 3 ? " or 3" : ""}`, length);
    return Array.from(vector);
}

let table; // of methods, by name

function known() {
    if (table) return table;
    table = new Map();
    const { method_at, method_order, method_forces, spring_method_name } = library();
    for (let i = 0, number; (number = method_at(i)) >= 0; i++) {
        const name = text(spring_method_name(number));
        const order = method_order(number); // 0: not for scenes
        if (order) table.set(name, { number, name, order, forcesPerStep: method_forces(number) });
    }
    return table;
}

export const methods = () =>
    Array.from(known().values(), ({ name, order, forcesPerStep }) => ({ name, order, forcesPerStep }));

export function methodNumber(name) {
    const method = known().get(name);
    check(method, "method", `one of ${[...known().keys()].join(", ")}`, name, TypeError);
    return method.number;
}

const checkNumber = (name, value, what = "a number") => check(typeof value === "number", name, what, value);

/** Copies numbers into the module. Getters of elements may create scenes, so they run before memory is taken. */
export function lend(take, values, name, Type = "float64", size = 8) {
    const numbers = ArrayBuffer.isView(values) ? values : Array.from(values);
    for (let i = 0; i < numbers.length; i++)
        if (typeof numbers[i] !== "number") checkNumber(`${name}[${i}]`, numbers[i], wanted[name]);
    const pointer = take(size * numbers.length);
    memory[Type](pointer, numbers.length).set(numbers);
    return pointer;
}

/** Copies which particles are pinned; 0: none is. */
export function lendPinned(take, pinned, particles) {
    if (!pinned) return 0;
    checkArray("pinned", pinned, particles);
    const flags = Array.from(pinned, (pin) => (pin ? 1 : 0));
    return lend(take, flags, "pinned", "uint8", 1);
}

const perLink = ["rest", "stiffness", "damping"];
const optional = new Set(["damping", "flags"]);
export const linkBytes = 40; // of spring_link
export const weightedBytes = 72; // of spring_weighted_link

/** How many links there are: of { ends, rest, stiffness, damping, flags } or of a list of { a, b, rest ... }. */
function countOf(links) {
    if (Array.isArray(links)) {
        for (const [i, link] of links.entries())
            checkKnown(`links[${i}]`, link, ["a", "b", ...perLink, "flags"]);
        return links.length;
    }
    checkKnown("links", links, ["ends", ...perLink, "flags"]);
    checkArray("links.ends", links.ends);
    check(links.ends.length % 2 === 0, "links.ends.length", "even", links.ends.length);
    const count = links.ends.length / 2;
    for (const name of [...perLink, "flags"]) {
        const value = links[name];
        if (typeof value !== "number" && (!optional.has(name) || value !== undefined))
            checkArray(`links.${name}`, value, count);
    }
    return count;
}

/** The value of a field of link i, as it is given. */
function linkValue(links, i, field) {
    if (Array.isArray(links)) {
        const { [field]: value = optional.has(field) ? 0 : undefined } = links[i];
        return value;
    }
    if (field === "a" || field === "b") return links.ends[2 * i + (field === "a" ? 0 : 1)];
    const value = links[field] ?? 0;
    return typeof value === "number" ? value : value[i];
}

/** Links in the layout of spring_link: [pointer, count]. Messages name the first of them `links[first]`. */
export function lendLinks(take, links, first = 0) {
    const count = countOf(links);
    const values = new Float64Array(5 * count);
    const ends = new Uint32Array(values.buffer);
    for (let i = 0; i < count; i++)
        for (const [k, field] of ["a", "b"].entries()) {
            const end = linkValue(links, i, field);
            const place = `links[${first + i}].${field}`;
            check(Number.isInteger(end) && end >= 0, place, "the index of a particle", end);
            ends[10 * i + k] = Math.min(end, 0xffffffff);
        }
    for (const [k, field] of perLink.entries())
        for (let i = 0; i < count; i++) {
            const value = linkValue(links, i, field);
            checkNumber(`links[${first + i}].${field}`, value);
            values[5 * i + 1 + k] = value;
        }
    for (let i = 0; i < count; i++) {
        const value = linkValue(links, i, "flags");
        check([0, 1, 2, 3].includes(value), `links[${first + i}].flags`, "0, TENSION_ONLY or TETHER", value);
        ends[10 * i + 8] = value;
    }
    return [lend(take, ends, "links", "uint32", 4), count];
}

/** Weighted links in the layout of spring_weighted_link: [pointer, count]. */
export function lendWeightedLinks(take, links) {
    checkKnown("weightedLinks", links, ["particles", "weights", ...perLink]);
    checkArray("weightedLinks.particles", links.particles);
    const { length } = links.particles;
    check(length % 4 === 0, "weightedLinks.particles.length", "a multiple of 4", length);
    checkArray("weightedLinks.weights", links.weights, length);
    const count = length / 4;
    const { rest = 0, stiffness, damping = 0 } = links;
    const each = Object.entries({ rest, stiffness, damping });
    for (const [name, value] of each)
        if (typeof value !== "number") checkArray(`weightedLinks.${name}`, value, count);
    const values = new Float64Array(9 * count);
    const words = new Uint32Array(values.buffer);
    for (let i = 0; i < length; i++) {
        const [row, k] = [Math.floor(i / 4), i % 4];
        const particle = links.particles[i];
        const place = `weightedLinks.particles[${i}]`;
        check(Number.isInteger(particle) && particle >= 0, place, "the index of a particle", particle);
        words[18 * row + k] = Math.min(particle, 0xffffffff);
        const weight = links.weights[i];
        checkNumber(`weightedLinks.weights[${i}]`, weight);
        values[9 * row + 2 + k] = weight;
    }
    for (let i = 0; i < count; i++)
        for (const [k, [name, value]] of each.entries()) {
            const one = typeof value === "number" ? value : value[i];
            checkNumber(`weightedLinks.${name}[${i}]`, one);
            values[9 * i + 6 + k] = one;
        }
    return [lend(take, words, "weightedLinks", "uint32", 4), count];
}

/** Weighted links in the layout of spring_weighted_link as { particles, weights, rest, stiffness, damping }. */
export function weightedLinksAt(pointer, count) {
    const words = memory.uint32(pointer, 18 * count);
    const values = memory.float64(pointer, 9 * count);
    const links = { particles: new Uint32Array(4 * count), weights: new Float64Array(4 * count) };
    for (const field of perLink) links[field] = new Float64Array(count);
    for (let i = 0; i < count; i++) {
        for (let k = 0; k < 4; k++) {
            links.particles[4 * i + k] = words[18 * i + k];
            links.weights[4 * i + k] = values[9 * i + 2 + k];
        }
        perLink.forEach((field, k) => (links[field][i] = values[9 * i + 6 + k]));
    }
    return links;
}

/** Links in the layout of spring_link as { ends, rest, stiffness, damping, flags }. */
export function linksAt(pointer, count) {
    const words = memory.uint32(pointer, 10 * count);
    const values = memory.float64(pointer, 5 * count);
    const links = { ends: new Uint32Array(2 * count) };
    for (const field of perLink) links[field] = new Float64Array(count);
    links.flags = new Uint32Array(count);
    for (let i = 0; i < count; i++) {
        links.ends[2 * i] = words[10 * i];
        links.ends[2 * i + 1] = words[10 * i + 1];
        perLink.forEach((field, k) => (links[field][i] = values[5 * i + 1 + k]));
        links.flags[i] = words[10 * i + 8];
    }
    return links;
}

export const wanted = {
    gravity: "a finite number",
    drag: "a finite number >= 0, also when it is divided by a mass",
    maxSpeed: "a finite number >= 0",
    particleRadius: "a finite number >= 0",
    particleFriction: "a finite number >= 0",
    position: "a finite number",
    velocity: "a finite number",
    mass: "a finite number > 0 with a finite reciprocal",
    a: "the index of a particle",
    b: "the index of another particle",
    rest: "a finite number >= 0",
    stiffness: "a finite number >= 0, also when it is divided by a mass",
    damping: "a finite number >= 0, also when it is divided by a mass",
    normal: "a direction in the plane of the scene",
    axes: "orthonormal to 1e-3",
    half: "numbers >= 0",
    restitution: "a number from 0 to 1",
};

/** Throws what is wrong with a link that is to replace the link `now`. */
export function refuseLink(links, i, index, now) {
    const [a, b, ...values] = ["a", "b", ...perLink].map((field) => linkValue(links, i, field));
    const same = [now.a, now.b].includes(a) && a + b === now.a + now.b;
    check(same, `ends of link ${index}`, `${now.a} and ${now.b}`, [a, b], RangeError);
    let k = values.findIndex((value) => !(value >= 0 && value < Infinity));
    if (k < 0) k = values[1] < values[2] ? 2 : 1; // too large for a mass
    check(false, `${perLink[k]} of link ${index}`, wanted[perLink[k]], values[k]);
}

/** Numbers of a collider, in the order of spring_collider: name, how many, and what it is by default. */
const fields = [
    ["at", 3, [0, 0, 0]],
    ["to", 3, [0, 0, 0]],
    ["axes", 9, [1, 0, 0, 0, 1, 0, 0, 0, 1]],
    ["half", 3, [0, 0, 0]],
    ["radius", 1, 0],
    ["velocity", 3, [0, 0, 0]],
    ["velocityTo", 3, null], // that of `at`
    ["spin", 3, [0, 0, 0]],
    ["friction", 1, 0],
    ["restitution", 1, 0],
    ["acceleration", 3, [0, 0, 0]],
    ["spinAcceleration", 3, [0, 0, 0]],
    ["surface", 3, [0, 0, 0]],
];
const shapes = ["plane", "sphere", "capsule", "box"];
// Fields that only some shapes have, and those that these shapes require.
const own = { plane: ["normal"], sphere: ["radius"], capsule: ["radius", "to", "velocityTo"] };
own.box = ["radius", "half", "axes"];
const special = new Set(Object.values(own).flat());
const required = { plane: [], sphere: ["radius"], capsule: ["to", "radius"], box: ["half"] };
const colliderNumbers = 39;
export const colliderBytes = 8 * 44; // shape, numbers, mask, two pointers, and two numbers of custom bodies

/** A unit vector by the rule of all bindings, which keeps the normals that getColliders() returns. */
function unit([x, y = 0, z = 0]) {
    const over = (size) => [x / size, y / size, z / size];
    const square = x * x + y * y + z * z;
    if (Math.abs(square - 1) <= 1e-15) return over(1);
    if (square > 1e-280 && square < 1e280) return over(Math.sqrt(square));
    const most = Math.max(...over(1).map(Math.abs));
    return most > 0 && most < Infinity ? unit(over(most)) : null;
}

/** Colliders in the layout of spring_collider, of a scene with so many axes. */
export function lendColliders(take, colliders, axes) {
    const pointer = take(colliderBytes * colliders.length);
    colliders.forEach((collider, i) => {
        const name = `colliders[${i}]`;
        checkKnown(name, collider, ["shape", "normal", "mask", ...fields.map(([field]) => field)]);
        const shape = shapes.indexOf(collider.shape);
        check(shape >= 0, `${name}.shape`, `one of ${shapes.join(", ")}`, collider.shape, TypeError);
        for (const field of special)
            if (collider[field] !== undefined && !own[collider.shape].includes(field))
                throw new TypeError(`${name}: the option ${field} does not go with ${collider.shape}`);
        for (const field of required[collider.shape])
            if (collider[field] === undefined) throw new TypeError(`${name}.${field} is required`);
        const numbers = [];
        for (const [field, count, usual] of fields) {
            const { [field]: value = usual ?? collider.velocity ?? [0, 0, 0] } = collider;
            const place = `${name}.${field}`;
            if (count === 1) checkFinite(place, value);
            else {
                if (count === 3) checkVector(place, value, field.startsWith("spin") ? 3 : axes);
                else checkArray(place, value, count);
                checkNumbers(place, value);
            }
            for (let k = 0; k < count; k++) numbers.push(count === 1 ? value : (value[k] ?? 0));
            if (field === "axes" && shape === 0) {
                const { normal = [0, 1, 0] } = collider;
                const direction = unit(checkVector(`${name}.normal`, normal, axes));
                check(direction, `${name}.normal`, "a direction", normal, RangeError);
                numbers.splice(6, 3, ...direction);
            }
        }
        const { mask = 0 } = collider;
        checkUpTo(`${name}.mask`, mask, 0xffffffff);
        const at = pointer + colliderBytes * i;
        memory.uint32(at, colliderBytes / 4).fill(0);
        memory.uint32(at, 1)[0] = shape;
        memory.float64(at + 8, colliderNumbers).set(numbers);
        memory.uint32(at + 8 + 8 * colliderNumbers, 1)[0] = mask;
    });
    return pointer;
}

/** Throws what spring_scene_check_colliders() has found. */
export function refuseCollider(colliders, pointer) {
    const [name, i] = memory.uint32(pointer, 2);
    const collider = colliders[i];
    let field = text(name);
    if (field === "axis") field = collider.shape === "plane" ? "normal" : "axes";
    const what = wanted[nameOf[field] ?? field] ?? "smaller";
    check(false, `colliders[${i}].${field}`, what, collider[field], RangeError);
}

/** Colliders from that layout. */
export function collidersAt(pointer, count) {
    return Array.from({ length: count }, (_, i) => {
        const at = pointer + colliderBytes * i;
        const numbers = memory.float64(at + 8, colliderNumbers);
        const collider = { shape: shapes[memory.uint32(at, 1)[0]] };
        let place = 0;
        for (const [field, size] of fields) {
            const value = Array.from(numbers.subarray(place, place + size));
            place += size;
            if (!special.has(field) || own[collider.shape].includes(field))
                collider[field] = size === 1 ? value[0] : value;
        }
        if (collider.shape === "plane") collider.normal = Array.from(numbers.subarray(6, 9));
        collider.mask = memory.uint32(at + 8 + 8 * colliderNumbers, 1)[0];
        return collider;
    });
}

const nameOf = { mass_all: "mass", max_speed: "maxSpeed", particle_radius: "particleRadius" };
Object.assign(nameOf, { radius: "particleRadius", friction: "particleFriction" });

/** Throws what def_check() has found in a definition. */
function refuse(definition, axes) {
    const field = text(library().failure_field());
    const i = library().failure_index();
    if (field === "methods")
        throw new TypeError(
            "rkn8 and srkn6 require undamped links, no tensionOnly, no colliders and no forceUsesVelocity",
        );
    if (field === "flags") throw new TypeError("tensionOnly requires 2 or 3 axes");
    if (["particles", "links", "weighted_links"].includes(field))
        throw new RangeError(`too many ${field} for a scene`);
    const [array, part] = field.split(".");
    if (field === "link.flags") throw new TypeError("flags of links require 2 or 3 axes");
    if (array === "weighted_link") {
        const what = { particle: "indices of different particles", weight: "finite numbers whose sum is 0" };
        const { [part]: values, particles, weights } = definition.weightedLinks;
        const row = (list) => Array.from(list).slice(4 * i, 4 * i + 4);
        const value =
            part === "particle" ? row(particles) : part === "weight" ? row(weights) : (values?.[i] ?? values);
        check(false, `weightedLinks[${i}].${part}`, what[part] ?? wanted[part], value, RangeError);
    }
    if (array === "link") {
        const value = linkValue(definition.links, i, part);
        check(false, `links[${i}].${part}`, wanted[part], value);
    }
    const name = nameOf[field] ?? field;
    let value = definition[name];
    let place = name;
    if (name === "position" || name === "velocity") {
        let at = axes * i;
        while (at < axes * i + axes - 1 && Number.isFinite(value[at])) at++;
        [place, value] = [`${name}[${at}]`, value[at]];
    } else if (typeof value === "object") [place, value] = [`${name}[${i}]`, value[i]];
    check(false, place, wanted[name], value);
}

/** Fills the definition in the module, and returns what of it JavaScript needs. `take` as in borrowed(). */
export function define(take, definition) {
    checkKnown("definition", definition, names);
    const { axes = 3, position, velocity, mass = 1, pinned, links = [], weightedLinks } = definition;
    const { gravity = [0, 0, 0], drag = 0, maxSpeed = 0, methods = [] } = definition;
    const { force = null, forceUsesVelocity = false, component = 0, base } = definition;
    const { colliders = 0, particleRadius = 0, particleFriction, particleMask, count } = definition;
    check([1, 2, 3].includes(axes), "axes", "1, 2 or 3", axes);
    checkArray("position", position);
    const { length } = position;
    check(length > 0 && length % axes === 0, "position.length", `a multiple of ${axes}`, length);
    const particles = length / axes;
    if (count !== undefined) {
        checkArray("count", count, 3);
        Array.from(count, (each, i) => checkCount(`count[${i}]`, each, 1));
        const all = count[0] * count[1] * count[2] === particles;
        check(all, "count", "that of all particles", count, RangeError);
    }
    if (velocity) checkArray("velocity", velocity, position.length);
    if (typeof mass === "number") check(mass > 0, "mass", wanted.mass, mass);
    else checkArray("mass", mass, particles);
    const [x = 0, y = 0, z = 0] = checkVector("gravity", gravity, axes);
    checkNumbers("gravity", gravity);
    checkArray("methods", methods);
    if (base) {
        checkArray("base", base, 3 * particles);
        checkNumbers("base", base);
    }
    checkUpTo("component", component, 3 - axes);
    check(force === null || typeof force === "function", "force", "a function or null", force, TypeError);
    let set = forceUsesVelocity ? 0 : forceIgnoresVelocity; // also without a force, which may be set later
    const used = {};
    for (const [name, flag] of Object.entries({ ...flags, forceUsesVelocity: 0 })) {
        const value = definition[name] ?? false;
        check(typeof value === "boolean", name, "a boolean", value, TypeError);
        if (value) set |= flag;
        used[name] = value;
    }
    const bits = Array.from(methods, (name) => 1 << methodNumber(name)).reduce((all, bit) => all | bit, 0);
    const radii = typeof particleRadius === "number" ? undefined : particleRadius;
    const radius = radii ? 0 : particleRadius;
    for (const [name, value] of Object.entries({ drag, maxSpeed, particleRadius: radius }))
        checkFinite(name, value);
    for (const [name, values] of Object.entries({ particleRadius: radii, particleFriction, particleMask }))
        if (values !== undefined) checkArray(name, values, particles);
    Array.from(particleMask ?? [], (mask, i) => checkUpTo(`particleMask[${i}]`, mask, 0xffffffff));
    checkUpTo("colliders", colliders, 32);
    check(colliders === 0 || axes > 1, "axes", "2 or 3 with colliders", axes);
    // Getters may create scenes, so the one definition in the module is filled when all arrays have been read.
    const given = (name, values, ...type) =>
        values && typeof values === "object" ? lend(take, values, name, ...type) : 0;
    const [linkPointer, linkCount] = lendLinks(take, links);
    const [weightedPointer, weightedCount] = weightedLinks ? lendWeightedLinks(take, weightedLinks) : [0, 0];
    const pins = lendPinned(take, pinned, particles);
    const state = Object.entries({ position, velocity, mass }).map(([name, values]) => given(name, values));
    const contacts = [
        given("particleRadius", radii),
        given("particleFriction", particleFriction),
        given("particleMask", particleMask, "uint32", 4),
    ];
    const basePointer = given("base", base, "float32", 4);
    const { def_begin, def_links, def_contacts, def_weighted_links, def_forces, def_check } = library();
    def_begin(axes, set, bits, particles, ...state, typeof mass === "number" ? mass : 0, pins);
    def_links(linkCount, linkPointer);
    def_contacts(colliders, radius, ...contacts);
    def_weighted_links(weightedCount, weightedPointer);
    def_forces(x, y, z, drag, maxSpeed, force !== null);
    if (def_check() !== 0) refuse({ ...definition, mass }, axes);
    return {
        ...used,
        axes,
        particles,
        links: linkCount,
        linkPointer,
        force,
        component,
        count,
        base: basePointer,
    };
}
