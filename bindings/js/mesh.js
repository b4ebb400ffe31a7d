// SPDX-License-Identifier: MIT
// Bending stiffness, tethers, and the links of triangle meshes.
import {
    checkArray,
    checkCount,
    checkKnown,
    checkNumbers,
    define,
    lend,
    lendPinned,
    linkBytes,
    linksAt,
    weightedBytes,
    weightedLinksAt,
} from "./definition.js";
import { borrowed, library, memory } from "./module.js";
import { check, checkNotNegative, checkPositive, isNumber } from "./options.js";

/** Values of `flags` of a link. */
export const TENSION_ONLY = 1;
export const TETHER = 2;

function checkBend(rigidity, options, known) {
    checkKnown("options", options, known);
    const { dampingTime = 0 } = options;
    for (const [name, value] of Object.entries({ rigidity, dampingTime })) checkNotNegative(name, value);
    return dampingTime;
}

/** Calls make(out, count), first to count. Returns a pointer to what is made, and their number. */
function counted(take, bytes, make, name, what) {
    const count = take(4);
    const call = (out) => {
        if (make(out, count) !== 0) throw new RangeError(`${name} must be ${what}`);
        return memory.uint32(count, 1)[0];
    };
    const pointer = take(bytes * call(0));
    return [pointer, call(pointer)];
}

export function bendRod(position, rigidity, options = {}) {
    const dampingTime = checkBend(rigidity, options, ["axes", "pinned", "dampingTime"]);
    const { axes = 3, pinned } = options;
    check([1, 2, 3].includes(axes), "axes", "1, 2 or 3", axes);
    checkArray("position", position);
    const particles = position.length / axes;
    check(Number.isInteger(particles), "position.length", `a multiple of ${axes}`, position.length);
    return borrowed((take) => {
        const [x, pins] = [lend(take, position, "position"), lendPinned(take, pinned, particles)];
        const { spring_bend_rod: make } = library();
        const rod = (out, count) => make(particles, axes, x, pins, rigidity, dampingTime, out, count);
        const what = "finite, and different from one particle to the next";
        return weightedLinksAt(...counted(take, weightedBytes, rod, "position", what));
    });
}

export function bendGrid(definition, rigidity, options = {}) {
    const dampingTime = checkBend(rigidity, options, ["pinned", "diagonals", "dampingTime"]);
    checkKnown("grid", definition, ["count", "spacing"]);
    const { count, spacing } = definition;
    const { diagonals = true, pinned } = options;
    checkArray("count", count);
    const [x, y = 1, z = 1] = count;
    [x, y, z].forEach((each, i) => checkCount(`count[${i}]`, each, 1));
    checkPositive("spacing", spacing);
    check(x * y * z < 2 ** 32, "count", "small enough for 32-bit indices", [x, y, z], RangeError);
    return borrowed((take) => {
        const pins = lendPinned(take, pinned, x * y * z);
        library().grid_begin(x, y, z, 3, false, spacing, 1, 1, 0, 0, 0, take(8));
        const { grid_bend: make } = library();
        const sheet = (out, number) => make(pins, diagonals, rigidity, dampingTime, out, number);
        return weightedLinksAt(...counted(take, weightedBytes, sheet, "count", "that of a sheet"));
    });
}

function lendTriangles(take, triangles) {
    checkArray("triangles", triangles);
    check(triangles.length % 3 === 0, "triangles.length", "a multiple of 3", triangles.length);
    for (let i = 0; i < triangles.length; i++)
        check(
            Number.isInteger(triangles[i]) && triangles[i] >= 0,
            `triangles[${i}]`,
            "an index",
            triangles[i],
        );
    const corners = Array.from(triangles, (corner) => Math.min(corner, 0xffffffff));
    return lend(take, corners, "triangles", "uint32", 4);
}

function lendVertices(take, position) {
    checkArray("position", position);
    check(position.length % 3 === 0, "position.length", "a multiple of 3", position.length);
    checkNumbers("position", position);
    return lend(take, position, "position");
}

export function bendMesh(position, triangles, rigidity, options = {}) {
    const dampingTime = checkBend(rigidity, options, ["pinned", "dampingTime"]);
    return borrowed((take) => {
        const [x, corners] = [lendVertices(take, position), lendTriangles(take, triangles)];
        const [particles, count] = [position.length / 3, triangles.length / 3];
        const pins = lendPinned(take, options.pinned, particles);
        const work = take(4 * (particles + 6 * count + 1));
        const { spring_bend_mesh: make } = library();
        const mesh = (out, number) =>
            make(particles, x, count, corners, pins, rigidity, dampingTime, out, number, work);
        const what = "triangles of particles, with areas and at most two at an edge";
        return weightedLinksAt(...counted(take, weightedBytes, mesh, "triangles", what));
    });
}

export function tethers(definition, fraction = 0.05, slack = 0) {
    checkPositive("fraction", fraction);
    checkNotNegative("slack", slack);
    return borrowed((take) => {
        const { axes, particles, links, linkPointer } = define(take, definition);
        check(axes > 1, "axes", "2 or 3 for tethers", axes);
        const all = take(linkBytes * (links + particles));
        memory.uint8(all, linkBytes * links).set(memory.uint8(linkPointer, linkBytes * links));
        const [count, work, distance] = [take(4), take(8 * particles), take(16 * particles)];
        memory.uint32(count, 1)[0] = particles;
        const status = library().def_tethers(fraction, slack, all + linkBytes * links, count, work, distance);
        const what = "small enough for links with finite values";
        check(status === 0, "fraction and slack", what, [fraction, slack], RangeError);
        return linksAt(all, links + memory.uint32(count, 1)[0]);
    });
}

export function fromMesh(definition) {
    checkKnown("mesh", definition, ["position", "triangles", "stiffness", "damping", "weld"]);
    const { position, triangles, stiffness, damping = 0, weld = 0 } = definition;
    for (const [name, value] of Object.entries({ stiffness, damping })) checkNotNegative(name, value);
    check(weld === null || (isNumber(weld) && weld >= 0), "weld", "null or a finite number >= 0", weld);
    return borrowed((take) => {
        const [x, corners] = [lendVertices(take, position), lendTriangles(take, triangles)];
        const [vertices, count] = [position.length / 3, triangles.length / 3];
        const work = take(4 * (3 * vertices + 6 * count + 1));
        const [number, particles] = [take(4 * vertices), take(4)];
        const { spring_links_from_mesh: make } = library();
        const mesh = (out, edges) =>
            make(vertices, x, count, corners, weld ?? -1, number, particles, out, edges, work);
        const what = "triangles of vertices, with areas, also after welding";
        const links = linksAt(...counted(take, linkBytes, mesh, "triangles", what));
        links.stiffness.fill(stiffness);
        links.damping.fill(damping);
        const particleOf = memory.uint32(number, vertices).slice();
        const places = new Float64Array(3 * memory.uint32(particles, 1)[0]);
        for (let i = vertices - 1; i >= 0; i--)
            for (let a = 0; a < 3; a++) places[3 * particleOf[i] + a] = position[3 * i + a];
        return {
            position: places,
            links,
            triangles: Uint32Array.from(triangles, (vertex) => particleOf[vertex]),
            particleOf,
        };
    });
}
