// SPDX-License-Identifier: MIT
// Mass-spring systems: the scenes of the C library.
import {
    checkArray,
    checkCount,
    checkKnown,
    checkNumbers,
    checkObject,
    checkUpTo,
    checkVector,
    colliderBytes,
    collidersAt,
    define,
    lend,
    lendColliders,
    lendLinks,
    linkBytes,
    linksAt,
    methodNumber,
    refuseCollider,
    refuseLink,
    wanted,
} from "./definition.js";
import { components, textureCoordinates, triangles } from "./grid.js";
import { borrowed, library, memory, NoMemory, withForce } from "./module.js";
import { check, checkFinite, checkPositive } from "./options.js";

const quantities = ["position", "velocity", "force"];
const notFinite = 2;
const disabled = 7;
const outOfRange = 5;
const unsupported = 6;
const unstable = 12;
const mismatch = 14;
// 64-bit words of the header of a saved state, from its second on. A hash covers the particles and flags of links, and with
// colliders the arrays of radii, frictions and masks.
const headers = [
    ..."version,precision,axes,flags,methods,colliders,particles,links,weightedLinks".split(","),
    "ends or arrays of particles",
    "force",
];
const stepFailures = {
    [notFinite]: ["a position or velocity would not be finite", "SPRING_ENONFINITE"],
    [unstable]: ["a particle would be faster than maxSpeed, or not finite", "SPRING_EUNSTABLE"],
};

const lost = new FinalizationRegistry((pointer) => library().scene_free(pointer));
const snapshots = new WeakMap(); // of a snapshot: { scene, bytes, force, frames, before, positions }

export class Scene {
    #pointer = 0; // of what wasm/scenes.c calls shown
    #scene = 0; // of the scene of the C library
    #force;
    #busy = false;
    #moving = false; // during a frame
    #error; // of the callback
    #views = { buffer: null }; // for the callback, by pointer
    #definition; // what define() returns, without the force

    constructor(definition) {
        borrowed((take) => {
            ({ force: this.#force, ...this.#definition } = define(take, definition));
            const { axes, particles, links, component, base } = this.#definition;
            this.#pointer = withForce(this.#callback, () => library().scene_new(component, base));
            if (this.#pointer === 0)
                throw new RangeError(`no memory for a scene of ${particles} particles and ${links} links`);
            this.#scene = library().scene_of(this.#pointer);
            const fixed = { axes, particles, links, positions: new Float32Array(3 * particles) };
            for (const [name, value] of Object.entries(fixed))
                Object.defineProperty(this, name, { value, enumerable: true });
        });
        if (new.target === Scene) Object.seal(this); // `scene.gravity = [0, 0, 0]` throws
        lost.register(this, this.#pointer, this);
        this.#show(library().scene_show(this.#pointer));
    }

    free() {
        if (this.#busy || this.#moving) throw new TypeError("a callback must not call its own scene");
        if (this.#pointer === 0) return;
        lost.unregister(this);
        library().scene_free(this.#pointer);
        this.#pointer = this.#scene = 0;
    }

    [Symbol.dispose ?? Symbol.for("Symbol.dispose")]() {
        this.free();
    }

    // --- steps ------------------------------------------------------------------------------------------------------

    advance(method, dt, steps = 1) {
        const number = methodNumber(method);
        checkFinite("dt", dt);
        checkCount("steps", steps);
        const { time } = this;
        // The last evaluation of rkn8 is for the next step: if it throws, the steps have been taken.
        const before = method === "rkn8" && this.#force && this.snapshot();
        try {
            this.#checked(this.#call("scene_advance", this.#pointer, number, dt, steps), method, dt);
        } catch (error) {
            if (before) this.restore(before);
            else if (this.#definition.noUndo || this.time !== time)
                this.#show(library().scene_moved(this.#pointer));
            throw error;
        }
        this.#show(library().scene_moved(this.#pointer));
    }

    frame(...values) {
        if (typeof values[0] !== "string" || typeof (values[1] ?? {}) === "object") {
            const [elapsed, options = {}] = values;
            checkObject("options", options);
            const { method = "leapfrog", dt = this.#usualStep(method), ...others } = options;
            return this.#frame(method, dt, elapsed, others);
        }
        const [method, dt, elapsed, options = {}] = values;
        return this.#frame(
            method,
            dt,
            elapsed,
            typeof options === "number" ? { mostSteps: options } : options,
        );
    }

    /** A part of 1/60 s: at most 1/240 s, and half of the stable step or a quarter, as games.md has it. */
    #usualStep(method) {
        const stable = this.stableStep(method);
        check(stable > 0, "dt", `given, because the stable step of ${method} is 0`);
        const most = Math.min(1 / 240, stable / (this.#definition.tensionOnly ? 4 : 2));
        return 1 / 60 / Math.ceil(1 / 60 / most);
    }

    #frame(method, dt, elapsed, options) {
        const number = methodNumber(method);
        checkPositive("dt", dt);
        checkFinite("elapsed", elapsed);
        checkKnown("options", options, ["mostSteps", "move"]);
        const { mostSteps = Math.max(1, Math.floor(0.25 / dt)), move = null } = options;
        const few = Number.isInteger(mostSteps) && mostSteps >= 1 && mostSteps < 2 ** 32;
        if (options.mostSteps === undefined) check(few, "dt", "at least 1e-10 without mostSteps", dt);
        check(few, "mostSteps", "an integer >= 1 and < 2^32", mostSteps);
        check(move === null || typeof move === "function", "move", "a function or null", move, TypeError);
        if (this.#moving) throw new TypeError("move must not call frame() of its own scene");
        const seconds = Math.max(elapsed, 0); // the time of a frame may be earlier than that of the event that starts it
        return borrowed((take) => {
            const pointer = take(16);
            const steps = this.#call("scene_begin_frame", this.#pointer, seconds, dt, mostSteps, pointer);
            if (steps < 0) throw new NoMemory(library().scene_bytes(this.#pointer) >>> 0);
            const [time, dropped] = memory.float64(pointer, 2);
            if (steps > 0)
                this.#take(number, dt, steps, seconds, move && (() => move(time, dropped)), method);
            else this.#call("scene_advance", this.#pointer, number, dt, 0); // sets impulses to 0
            this.#show(library().scene_end_frame(this.#pointer));
            return steps;
        });
    }

    /** The steps of a frame, or none of them. */
    #take(number, dt, steps, seconds, move, method) {
        const force = this.#force;
        this.#moving = true;
        try {
            const result = move?.();
            check(typeof result?.then !== "function", "move", "synchronous", result, TypeError);
            this.#checked(this.#call("scene_take_frame", this.#pointer, number, dt, steps), method, dt);
        } catch (error) {
            this.#show(library().scene_undo_frame(this.#pointer, seconds));
            this.#force = force;
            throw error;
        } finally {
            this.#moving = false;
        }
    }

    stableStep(method = "leapfrog") {
        return this.#call("spring_scene_stable_step", this.#scene, methodNumber(method));
    }

    get time() {
        return this.#call("spring_scene_time", this.#scene);
    }

    get energy() {
        return borrowed((take) => {
            const pointer = take(24);
            this.#call("spring_scene_energy", pointer, this.#scene);
            const [kinetic, elastic, gravity] = memory.float64(pointer, 3);
            return { kinetic, elastic, gravity, total: kinetic + elastic + gravity };
        });
    }

    atRest(speed, acceleration) {
        checkFinite("speed", speed);
        checkFinite("acceleration", acceleration);
        return this.#call("spring_scene_at_rest", this.#scene, speed, acceleration) !== 0;
    }

    // --- state ------------------------------------------------------------------------------------------------------

    get(quantity, first = 0, count = this.particles - first) {
        const number = this.#quantity(quantity);
        this.#checkRange(first, count, this.particles);
        return borrowed((take) => {
            const pointer = take(8 * this.axes * count);
            this.#changed(this.#call("spring_scene_get", this.#scene, number, pointer, 0, first, count));
            return memory.float64(pointer, this.axes * count).slice();
        });
    }

    set(quantity, values, first = 0) {
        const number = this.#quantity(quantity);
        checkArray(quantity, values);
        const count = values.length / this.axes;
        check(Number.isInteger(count), `${quantity}.length`, `a multiple of ${this.axes}`, values.length);
        this.#checkRange(first, count, this.particles);
        checkNumbers(quantity, values);
        borrowed((take) => {
            const pointer = lend(take, values, quantity);
            this.#changed(this.#call("spring_scene_set", this.#scene, number, pointer, 0, first, count));
        });
        if (number === 0) this.#show(library().scene_moved(this.#pointer));
    }

    triangles() {
        return triangles(this.#gridCount());
    }

    textureCoordinates() {
        return textureCoordinates(this.#gridCount());
    }

    #gridCount() {
        if (!this.#definition.count) throw new TypeError("the scene is defined without the count of a grid");
        return this.#definition.count;
    }

    transform(matrix) {
        checkArray("matrix", matrix);
        check([12, 16].includes(matrix.length), "matrix.length", "12 or 16", matrix.length);
        checkNumbers("matrix", matrix);
        const rows =
            matrix.length === 12
                ? matrix
                : Array.from({ length: 12 }, (_, k) => matrix[4 * (k % 4) + Math.floor(k / 4)]);
        borrowed((take) =>
            this.#checked(this.#call("spring_scene_transform", this.#scene, lend(take, rows, "matrix"))),
        );
        this.#show(library().scene_moved(this.#pointer));
    }

    setGravity(gravity) {
        const vector = [...checkVector("gravity", gravity, this.axes), 0, 0].slice(0, 3);
        checkNumbers("gravity", vector);
        borrowed((take) =>
            this.#call("spring_scene_set_gravity", this.#scene, lend(take, vector, "gravity")),
        );
    }

    get force() {
        return this.#force;
    }

    set force(force) {
        check(force === null || typeof force === "function", "force", "a function or null", force, TypeError);
        this.#checked(this.#call("scene_set_force", this.#pointer, force !== null));
        this.#force = force;
    }

    snapshot() {
        const size = this.#call("scene_bytes", this.#pointer) >>> 0;
        const snapshot = Object.freeze({ time: this.time });
        const bytes = memory.uint8(this.#scene, size).slice();
        const [frames, before] = this.#frames().map((array) => array.slice());
        const positions = this.positions.slice();
        snapshots.set(snapshot, { scene: this, bytes, force: this.#force, frames, before, positions });
        return snapshot;
    }

    restore(snapshot) {
        const kept = snapshots.get(snapshot);
        check(kept?.scene === this, "snapshot", "a snapshot of this scene", snapshot, TypeError);
        this.#call("scene_bytes", this.#pointer); // throws if the scene has been freed
        memory.uint8(this.#scene, kept.bytes.length).set(kept.bytes);
        this.#force = kept.force;
        library().scene_moved(this.#pointer);
        const [frames, before] = this.#frames();
        frames.set(kept.frames);
        if (!this.#moving) before.set(kept.before); // a frame replaces it, unless it fails
        this.positions.set(kept.positions);
    }

    save() {
        return borrowed((take) => {
            const size = take(4);
            this.#checked(this.#call("spring_scene_save", this.#scene, 0, size));
            const [bytes] = memory.uint32(size, 1);
            const pointer = take(bytes);
            this.#call("spring_scene_save", this.#scene, pointer, size);
            return memory.uint8(pointer, bytes).slice();
        });
    }

    load(state) {
        const isBytes = ArrayBuffer.isView(state) && state.BYTES_PER_ELEMENT === 1;
        check(isBytes, "state", "a Uint8Array", state, TypeError);
        borrowed((take) => {
            const pointer = take(state.length);
            memory.uint8(pointer, state.length).set(state);
            const status = this.#call("spring_scene_load", this.#scene, pointer, state.length);
            let what = "an undamaged state";
            if (status === mismatch) {
                const own = new Uint32Array(this.save().buffer, 0, 24);
                const its = memory.uint32(pointer, 24);
                const differs = (_, k) => [2, 3].some((half) => own[2 * k + half] !== its[2 * k + half]);
                const other = headers.filter(differs).join(", ") || "damping";
                what = `the state of a scene with this definition, not with other ${other}`;
            }
            check(status === 0, "state", what, `${state.length} bytes`, RangeError);
        });
        this.#frames()[0].fill(0);
        this.#show(library().scene_moved(this.#pointer));
    }

    setTime(t) {
        checkFinite("t", t);
        this.#call("spring_scene_set_time", this.#scene, t);
    }

    /** What wasm/scenes.c calls frames, and the state before the last step, which is empty before the first frame. */
    #frames() {
        const before = library().scene_before(this.#pointer);
        return [
            memory.float64(library().scene_frames(this.#pointer), 4 + 6 * 32),
            memory.float64(before, before ? this.axes * this.particles : 0),
        ];
    }

    // --- pins, masses, links ----------------------------------------------------------------------------------------

    pin(first, count = 1) {
        this.#pins(first, count, 1);
    }

    unpin(first, count = 1) {
        this.#pins(first, count, 0);
    }

    #pins(first, count, pinned) {
        this.#checkRange(first, count, this.particles);
        borrowed((take) => {
            const pointer = lend(take, Array(count).fill(pinned), "pinned", "uint8", 1);
            this.#changed(this.#call("spring_scene_set_pinned", this.#scene, first, count, pointer));
        });
    }

    drive(particle, target, duration = 1) {
        this.#checkIndex("particle", particle, this.particles);
        if (target !== null) {
            checkArray("target", target, this.axes);
            checkNumbers("target", target);
            checkPositive("duration", duration);
        }
        borrowed((take) => {
            const pointer = target === null ? 0 : lend(take, target, "target");
            const status = this.#call("spring_scene_drive", this.#scene, particle, pointer, duration);
            check(status === 0, "particle", "pinned, and its velocity finite", particle, RangeError);
        });
    }

    setMass(mass, first = 0) {
        checkArray("mass", mass);
        this.#checkRange(first, mass.length, this.particles);
        for (let i = 0; i < mass.length; i++) checkPositive(`mass[${i}]`, mass[i]);
        borrowed((take) => {
            this.#edit("spring_scene_set_mass", first, mass.length, lend(take, mass, "mass"), 8, (i) =>
                check(false, `mass[${i}]`, `${wanted.mass}, also times stiffness or drag`, mass[i]),
            );
        });
    }

    getLink(index) {
        this.#checkIndex("link", index, this.links);
        return borrowed((take) => {
            const pointer = take(linkBytes);
            this.#call("spring_scene_get_link", this.#scene, index, pointer);
            const [a, b] = memory.uint32(pointer, 2);
            const [rest, stiffness, damping] = memory.float64(pointer + 8, 3);
            const [flags] = memory.uint32(pointer + 32, 1);
            return { a, b, rest, stiffness, damping, flags };
        });
    }

    getLinks() {
        return borrowed((take) => {
            const pointer = take(linkBytes * this.links);
            this.#call("scene_links", this.#pointer, pointer);
            return linksAt(pointer, this.links);
        });
    }

    setLink(index, changes) {
        checkObject("changes", changes);
        const link = this.getLink(index);
        for (const field in changes) if (changes[field] !== undefined) link[field] = changes[field];
        this.#setLinks([link], index, index);
    }

    setLinks(links, first = 0) {
        this.#setLinks(links, first);
    }

    #setLinks(links, first, named) {
        borrowed((take) => {
            const [pointer, count] = lendLinks(take, links, named);
            this.#checkRange(first, count, this.links);
            this.#edit("spring_scene_set_links", first, count, pointer, linkBytes, (i) =>
                refuseLink(links, i, first + i, this.getLink(first + i)),
            );
        });
    }

    cut(index) {
        this.setLink(index, { stiffness: 0, damping: 0 });
    }

    tear(stretch) {
        const limits = typeof stretch !== "number";
        if (limits) checkArray("stretch", stretch, this.links);
        Array.from(limits ? stretch : [stretch], (each, i) => {
            const name = limits ? `stretch[${i}]` : "stretch";
            check(typeof each === "number" && each >= 0, name, "a number >= 0", each);
        });
        return borrowed((take) => {
            const torn = take(4 * this.links);
            const count = take(4);
            const limit = limits ? lend(take, stretch, "stretch") : 0;
            const one = limits ? 0 : stretch;
            this.#changed(this.#call("spring_scene_tear", this.#scene, one, limit, torn, this.links, count));
            return memory.uint32(torn, memory.uint32(count, 1)[0]).slice();
        });
    }

    components() {
        return components(this.particles, this.getLinks());
    }

    findLink(a, b) {
        this.#checkIndex("a", a, this.particles);
        this.#checkIndex("b", b, this.particles);
        return this.#call("spring_scene_find_link", this.#scene, a, b) | 0; // -1: none
    }

    tension(link) {
        this.#checkIndex("link", link, this.links);
        return this.#call("spring_scene_tension", this.#scene, link);
    }

    // --- contacts ---------------------------------------------------------------------------------------------------

    setColliders(colliders) {
        checkArray("colliders", colliders);
        const list = Array.from(colliders);
        borrowed((take) => {
            const pointer = lendColliders(take, list, this.axes);
            const status = this.#call("spring_scene_set_colliders", this.#scene, pointer, list.length);
            if (status === disabled) throw new TypeError("the scene is defined without colliders");
            check(status !== outOfRange, "colliders.length", "at most what the definition has", list.length);
            if (status === 0) return this.#frames()[0].fill(0, 4);
            const found = take(8);
            this.#call("spring_scene_check_colliders", this.#scene, pointer, list.length, found, found + 4);
            refuseCollider(list, found);
        });
    }

    getColliders() {
        return borrowed((take) => {
            const count = take(4);
            this.#call("spring_scene_get_colliders", this.#scene, 0, count);
            const [colliders] = memory.uint32(count, 1);
            const pointer = take(colliderBytes * colliders);
            this.#call("spring_scene_get_colliders", this.#scene, pointer, count);
            return collidersAt(pointer, colliders);
        });
    }

    touching(first = 0, count = this.particles - first) {
        this.#checkRange(first, count, this.particles);
        return borrowed((take) => {
            const pointer = take(4 * count);
            const status = this.#call("spring_scene_touching", this.#scene, pointer, first, count);
            if (status === disabled) throw new TypeError("the scene is defined without colliders");
            return memory.uint32(pointer, count).slice();
        });
    }

    impulse(collider) {
        check(Number.isInteger(collider) && collider >= 0, "collider", "an index", collider, RangeError);
        return borrowed((take) => {
            const pointer = take(48);
            const status = this.#call("spring_scene_impulses", this.#scene, pointer, collider, 1);
            if (status === disabled) throw new TypeError("the scene is defined without colliders");
            if (status !== 0)
                throw new RangeError(`collider: ${collider}, but the scene has fewer colliders now`);
            const earlier = this.#frames()[0].subarray(4 + 6 * collider);
            const all = memory.float64(pointer, 6).map((each, i) => each + earlier[i]);
            return { linear: all.slice(0, 3), angular: all.slice(3) };
        });
    }

    // --- how this calls the library ---------------------------------------------------------------------------------

    #call(name, ...values) {
        if (this.#pointer === 0) throw new TypeError("the scene has been freed");
        if (this.#busy) throw new TypeError("a callback must not call its own scene");
        this.#busy = true;
        this.#error = undefined;
        try {
            return withForce(this.#callback, () => library()[name](...values));
        } finally {
            this.#busy = false;
            const error = this.#error;
            this.#error = undefined;
            // eslint-disable-next-line no-unsafe-finally -- what the callback threw is the reason for all else
            if (error) throw error.thrown;
        }
    }

    #callback = (t, position, velocity, force) => {
        const arrays = (pointers) =>
            Array.from(memory.uint32(pointers, this.axes), (pointer) => this.#viewOf(pointer));
        const forces = arrays(force);
        try {
            const velocities = this.#definition.forceUsesVelocity ? arrays(velocity) : undefined;
            const result = this.#force(t, arrays(position), forces, velocities);
            check(typeof result?.then !== "function", "force", "synchronous", result, TypeError);
            // Forces that were written after memory grew are lost.
            if (this.#views.buffer !== library().memory.buffer)
                throw new TypeError("memory grew during force: create scenes and grids outside of it");
        } catch (thrown) {
            this.#error ??= { thrown };
            // The step fails, so that the scene stays as it was. Memory may have grown meanwhile.
            for (const each of arrays(force)) each.fill(NaN);
        }
    };

    #viewOf(pointer) {
        const { buffer } = library().memory;
        if (this.#views.buffer !== buffer) this.#views = { buffer };
        return (this.#views[pointer] ??= new Float64Array(buffer, pointer, this.particles));
    }

    #show(pointer) {
        this.positions.set(memory.float32(pointer, 3 * this.particles));
    }

    #quantity(name) {
        const number = quantities.indexOf(name);
        check(number >= 0, "quantity", `one of ${quantities.join(", ")}`, name, TypeError);
        if (number === 2 && !this.#definition.heldForces)
            throw new TypeError("the scene is defined without heldForces");
        return number;
    }

    #checkIndex(name, index, count) {
        check(Number.isInteger(index) && index >= 0 && index < count, name, `an index below ${count}`, index);
    }

    #checkRange(first, count, all) {
        checkUpTo("first", first, all);
        checkCount("count", count);
        check(first + count <= all, "first + count", `at most ${all}`, first + count);
    }

    /** Changes `count` values at a pointer, or none, and then throws refuse(i) for the first invalid one. */
    #edit(name, first, count, pointer, bytes, refuse) {
        const change = (i, n) => this.#call(name, this.#scene, first + i, n, pointer + i * bytes);
        const status = change(0, count);
        if (status === 0 || status === disabled) return this.#changed(status);
        const saved = this.snapshot();
        let i = 0;
        while (i < count - 1 && change(i, 1) === 0) i++;
        this.restore(saved);
        refuse(i);
    }

    /** The status of a change. */
    #changed(status) {
        if (status === disabled) throw new TypeError("the scene is defined without editable");
        if (status !== 0) throw new RangeError("the values are not valid for this scene");
    }

    /** The status of steps. */
    #checked(status, method, dt) {
        if (status === 0) return;
        if (status === disabled) throw new TypeError(`the scene is defined without the method ${method}`);
        if (status === unsupported)
            throw new TypeError(
                method === "euler"
                    ? "the method euler does not support colliders"
                    : `the method ${method} requires forces that do not depend on velocities`,
            );
        if (dt === undefined) throw new RangeError(stepFailures[notFinite][0]);
        const [what, code] = stepFailures[status] ?? ["the step is not valid"];
        const stable = this.stableStep(method);
        const error = new RangeError(`${what}; dt is ${dt}, the stable step of ${method} is ${stable}`);
        throw code ? Object.assign(error, { code }) : error;
    }
}
