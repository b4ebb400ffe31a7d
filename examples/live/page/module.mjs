// SPDX-License-Identifier: MIT
// The WebAssembly module: the library, and labs, one for each run of a scene. See module/lab.c.

const decoder = new TextDecoder();

export class Module {
    static async load(bytes) {
        const { instance } = await WebAssembly.instantiate(bytes, {});
        instance.exports._initialize();
        return new Module(instance.exports);
    }

    constructor(calls) {
        this.calls = calls;
        this.methods = [];
        this.numbers = {};
        for (let i = 0, number; (number = calls.lab_method(i)) >= 0; i++) {
            const name = this.text(calls.lab_method_name(number));
            this.numbers[name] = number;
            this.methods.push(name);
        }
        this.scenes = [];
        for (let i = 0, name; (name = calls.lab_scene_name(i)) !== 0; i++) this.scenes.push(this.text(name));
    }

    text(address) {
        const bytes = new Uint8Array(this.calls.memory.buffer, address);
        return decoder.decode(bytes.slice(0, bytes.indexOf(0)));
    }

    orderOf(method) {
        return this.calls.lab_method_order(this.numbers[method]);
    }

    forcesPerStep(method) {
        return this.calls.lab_forces_per_step(this.numbers[method]);
    }

    /** A run is {scene, size, damping, drag, mass, endMass, stiffness, calm}; but for the scene all may be left out. */
    make(run) {
        const {
            scene,
            size = 0,
            damping = NaN,
            drag = NaN,
            mass = NaN,
            endMass = NaN,
            stiffness = NaN,
        } = run;
        const kind = this.scenes.indexOf(scene);
        const calm = run.calm ? 1 : 0;
        const address =
            kind < 0 ? 0 : this.calls.lab_new(kind, size, damping, drag, mass, endMass, stiffness, calm);
        if (address === 0) throw new Error(`no scene of ${JSON.stringify(run)}`);
        return new Lab(this, address);
    }
}

export class Lab {
    constructor(module, address) {
        this.module = module;
        this.calls = module.calls;
        this.address = address;
        const { calls } = this;
        this.particles = calls.lab_particles(address);
        this.links = calls.lab_links(address);
        this.count = [0, 1, 2].map((axis) => calls.lab_count(address, axis));
        this.length = calls.lab_length(address);
        this.massRatio = calls.lab_mass_ratio(address);
    }

    free() {
        this.calls.lab_free(this.address);
        this.address = 0;
    }

    method(name) {
        return this.module.numbers[name];
    }

    takes(method) {
        return this.calls.lab_takes(this.address, this.method(method)) !== 0;
    }

    /** Returns how many of n steps it survives. */
    advance(method, stepsPerFrame, n) {
        return this.calls.lab_advance(this.address, this.method(method), stepsPerFrame, n);
    }

    /** How many steps are due when so many seconds have passed. */
    due(seconds, stepsPerFrame, most) {
        return this.calls.lab_due(this.address, seconds, stepsPerFrame, most);
    }

    get time() {
        return this.calls.lab_time(this.address);
    }

    get energies() {
        const address = this.calls.lab_energies(this.address);
        const [kinetic, elastic, gravity] = new Float64Array(this.calls.memory.buffer, address, 3);
        return { kinetic, elastic, gravity, total: kinetic + elastic + gravity };
    }

    get farthest() {
        return this.calls.lab_farthest(this.address);
    }

    stableStep(method) {
        return this.calls.lab_stable_step(this.address, this.method(method));
    }

    hash() {
        return BigInt.asUintN(64, this.calls.lab_hash(this.address)).toString(16).padStart(16, "0");
    }

    distance(other) {
        return this.calls.lab_distance(this.address, other.address);
    }

    poke(x, y, force, area, at = this.time) {
        return this.calls.lab_poke(this.address, at, x, y, force, area) !== 0;
    }

    grab(particle) {
        this.calls.lab_grab(this.address, particle);
    }

    drag(x, y, z) {
        this.calls.lab_drag(this.address, x, y, z);
    }

    release() {
        this.calls.lab_release(this.address);
    }

    tear(most) {
        return this.calls.lab_tear(this.address, most);
    }

    snip(particle) {
        return this.calls.lab_snip(this.address, particle);
    }

    wind(speed) {
        this.calls.lab_wind(this.address, speed);
    }

    rain(dropsPerSecond) {
        this.calls.lab_rain(this.address, dropsPerSecond);
    }

    dropBall(x, y, height) {
        this.calls.lab_ball_drop(this.address, x, y, height);
    }

    /** [x, y, height, radius], or null */
    get ball() {
        if (!this.calls.lab_ball_there(this.address)) return null;
        return [0, 1, 2, 3].map((which) => this.calls.lab_ball(this.address, which));
    }

    // Copies: the memory of the module moves when it grows.

    positions(stepsPerFrame) {
        const address = this.calls.lab_draw(this.address, stepsPerFrame);
        return new Float32Array(this.calls.memory.buffer, address, 3 * this.particles).slice();
    }

    get cut() {
        return new Uint8Array(this.calls.memory.buffer, this.calls.lab_cut(this.address), this.links).slice();
    }

    get ends() {
        return new Uint32Array(
            this.calls.memory.buffer,
            this.calls.lab_ends(this.address),
            2 * this.links,
        ).slice();
    }

    get pinned() {
        return new Uint8Array(
            this.calls.memory.buffer,
            this.calls.lab_pinned(this.address),
            this.particles,
        ).slice();
    }
}
