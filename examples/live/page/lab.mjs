// SPDX-License-Identifier: MIT
// A lab is the simulation of one pane: a preset scene, its disturbances, and its states for drawing.
import { bendGrid, grid, methods, Scene, tethers } from "springstep/scenes";
import { hashOf, preset, Pushes, takeSteps } from "../../../tools/scenes/presets.mjs";
import { curtain, Sphere } from "./curtain.mjs";
import { Hand } from "./grip.mjs";
import { Ball, peakOfDrop, random, wind } from "./weather.mjs";

const frameRate = 60;

export const methodTable = new Map(); // by name, in the order of tables

/** Fills methodTable. This compiles the library if it is not compiled yet. */
export function listMethods() {
    for (const method of methods()) methodTable.set(method.name, method);
}

function takes(definition, method) {
    if (definition.colliders && method === "euler") return false; // Euler does not support contacts, and would fail when it advances
    try {
        new Scene({ ...definition, methods: [method] }).free();
        return true;
    } catch (error) {
        if (error instanceof TypeError) return false;
        throw error;
    }
}

/** Adds bending stiffness and tethers to the definition of a sheet, as spring-scene --bend and --tethers do. */
function strengthen({ definition, count, settings }) {
    const { bend, tethers: fraction, length } = settings;
    const { pinned } = definition;
    const spacing = length / (count[0] - 1);
    if (bend) definition.weightedLinks = bendGrid({ count, spacing }, bend, { pinned });
    if (fraction) definition.links = tethers(definition, fraction);
}

export class Lab {
    /** A run is {scene, size, damping, drag, mass, endMass, stiffness, bend, tethers}; all except the scene are
        optional. */
    constructor(run) {
        if (methodTable.size === 0) listMethods();
        const asked = { ...run, size: run.size || undefined };
        this.preset = run.scene === "curtain" ? curtain(grid, asked) : preset(grid, asked);
        const { definition, count, settings } = this.preset;
        const links = definition.links.ends.length / 2; // without tethers, which come last
        strengthen(this.preset);
        this.taken = new Set([...methodTable.keys()].filter((name) => takes(definition, name)));
        // Water is not edited, and links that cannot be edited take less memory.
        const editable = run.scene !== "water";
        this.scene = new Scene({ ...definition, editable, methods: [...this.taken] });
        const { particles } = this.scene;
        Object.assign(this, { particles, links, count, length: settings.length });
        this.massRatio = settings.endMass === undefined ? 1 : settings.endMass / settings.mass;
        this.ends = definition.links.ends;
        this.pinned = definition.pinned;
        this.cut = new Uint8Array(this.scene.links);
        this.pushes = new Pushes(this.preset);
        this.hand = new Hand(this);
        this.ball = null;
        this.sphere = null;
        this.windSpeed = this.dropRate = this.nextDrop = this.pending = 0;
        this.random = random(1);
        this.now = this.xyz();
        this.before = this.now;
        if (run.scene === "water") this.pushes.pokeWater();
        this.feel();
    }

    free() {
        this.scene.free();
    }

    // Without a callback, steps take one pass over memory, with bit-identical results. But leapfrog keeps the force of
    // damped links as a part of the state, and evaluates it again after a change of the callback. So with damped links
    // the callback is kept.
    feel() {
        const needed = this.windSpeed > 0 || this.preset.settings.damping > 0 || this.pushes.any;
        if (needed !== (this.scene.force !== null)) this.scene.force = needed ? this.force : null;
    }

    force = (t, position, force) => {
        this.pushes.force(t, position, force);
        if (this.windSpeed > 0) wind(this.windSpeed, this.count, t, position, force);
    };

    /** Positions as x y z with z up, in double precision. */
    xyz() {
        const { axes } = this.preset.definition;
        const position = this.scene.get("position");
        if (axes === 3) return position;
        const xyz = this.preset.start.slice();
        for (let i = 0; i < this.particles; i++) {
            if (axes === 2) [xyz[3 * i], xyz[3 * i + 2]] = [position[2 * i], position[2 * i + 1]];
            else xyz[3 * i + 2] = position[i];
        }
        return xyz;
    }

    takes(method) {
        return this.taken.has(method);
    }

    // Takes n steps and stores the state before the last step for drawing. If the scene explodes, returns false and
    // restores the scene.
    take(method, dt, n) {
        const saved = this.scene.snapshot();
        try {
            this.scene.advance(method, dt, n - 1);
            this.before = this.xyz();
            this.scene.advance(method, dt, 1);
            if (Number.isFinite(this.scene.energy.total)) return true;
        } catch (error) {
            if (!error.code) throw error;
        }
        this.scene.restore(saved);
        return false;
    }

    /** Takes up to n steps of 1/(60 stepsPerFrame) s, until the scene explodes; returns the number taken. The pointer is
        where it is `late` seconds after these steps. */
    advance(method, stepsPerFrame, n, late = 0) {
        if (n === 0) return 0;
        const dt = 1 / (frameRate * stepsPerFrame);
        const duration = n * dt;
        this.hand.pull(duration + late);
        if (this.sphere) this.scene.setColliders([this.sphere.advance(duration, late)]);
        this.letItRain(this.time + duration);
        this.ball?.advance(duration);
        const all = this.take(method, dt, n);
        const taken = all ? n : takeSteps(this.scene, method, dt, n);
        this.now = this.xyz();
        if (!all) this.before = this.now; // the state stored by take() was undone
        this.pushes.forget(this.time);
        this.feel();
        if (this.sphere?.gone) {
            this.sphere = null;
            this.scene.setColliders([]);
        }
        return taken;
    }

    /** Returns the number of steps due after a time; more than `most` are dropped. */
    due(seconds, stepsPerFrame, most) {
        if (!(seconds >= 0)) return 0; // the first frame can begin before the page
        const dt = 1 / (frameRate * stepsPerFrame);
        const total = this.pending + seconds;
        this.pending = total % dt;
        return Math.min(Math.round((total - this.pending) / dt), most);
    }

    /** x y z of all particles at the time of the clock, interpolated between the last two states. */
    positions(stepsPerFrame) {
        const alpha = Math.min(this.pending * frameRate * stepsPerFrame, 1);
        const { before, now } = this;
        return Float32Array.from(now, (to, i) => before[i] + alpha * (to - before[i]));
    }

    get time() {
        return this.scene.time;
    }

    /** The largest distance of a particle from its start [m]. */
    get farthest() {
        const { start } = this.preset;
        let most = 0;
        for (let i = 0; i < start.length; i += 3)
            most = Math.max(most, Math.hypot(...[0, 1, 2].map((k) => this.now[i + k] - start[i + k])));
        return most;
    }

    hash() {
        return hashOf(this.scene);
    }

    /** Root mean square of the distances to the particles of another lab [m]. */
    distance(other) {
        const sum = this.now.reduce((all, x, i) => all + (x - other.now[i]) ** 2, 0);
        return Math.sqrt(sum / this.particles);
    }

    /** Adds a push with a peak force [N], as spring-scene --poke does. */
    poke(x, y, peak, area, start = this.time) {
        this.pushes.add({ start, x, y, peak, area });
        this.feel();
    }

    grab(particle) {
        this.hand.grab(particle);
    }

    drag(x, y, z) {
        this.hand.target = [x, y, z];
    }

    release() {
        this.hand.release();
    }

    /** Starts a sphere at the viewer, or moves the target of the current one to (x, z) [m]. */
    push(x, z) {
        this.sphere ??= new Sphere(x, z);
        Object.assign(this.sphere, { target: [x, z], held: true });
    }

    /** Releases the sphere, which then moves straight on until it vanishes. */
    letGo() {
        if (this.sphere) this.sphere.held = false;
    }

    /** Cuts the links that are longer than `most` times their rest length (one number, or one for each link), bending
        across them, and the tethers of a piece that comes off. */
    tear(most) {
        const torn = this.scene.tear(most);
        for (const link of torn) this.cut[link] = 1;
        if (torn.length === 0) return;
        const { component } = this.scene.components();
        for (let i = this.links; i < this.scene.links; i++)
            if (!this.cut[i] && component[this.ends[2 * i]] !== component[this.ends[2 * i + 1]]) {
                this.scene.cut(i);
                this.cut[i] = 1;
            }
    }

    /** Cuts all links of a particle. */
    snip(particle) {
        const most = new Float64Array(this.scene.links).fill(Infinity);
        this.ends.forEach((end, i) => end === particle && (most[i >> 1] = 0));
        this.tear(most);
    }

    wind(speed) {
        this.windSpeed = this.preset.definition.axes === 3 ? speed : 0;
        this.feel();
        if (this.scene.force) this.scene.force = this.force; // discards a kept force, which has the old wind
    }

    rain(dropsPerSecond) {
        this.dropRate = dropsPerSecond;
        this.nextDrop = this.time;
    }

    letItRain(until) {
        if (!(this.dropRate > 0)) return;
        const gap = 1 / this.dropRate;
        const { start, settings } = this.preset;
        for (; this.nextDrop < until; this.nextDrop += gap)
            this.pushes.add({
                start: this.nextDrop + gap * this.random(),
                x: start.at(-3) * this.random(),
                y: start.at(-2) * this.random(),
                peak: peakOfDrop(settings.mass),
                area: (settings.length / 16) ** 2,
            });
        this.feel();
    }

    dropBall(x, y, height) {
        this.ball = new Ball(this, x, y, height);
    }

    /** Height [m] of the water at a point. */
    level(x, y) {
        const spacing = this.length / (this.count[0] - 1);
        const [i, j] = [x, y].map((each) => Math.round(each / spacing));
        return this.now[3 * (i + this.count[0] * j) + 2];
    }
}
