// SPDX-License-Identifier: MIT
// The cloth and the water of the page in plain JavaScript, for times.mjs: leapfrog over links in typed arrays, without
// drag.

const pinnedOf = (lab) => Uint8Array.from(lab.pinned);

function clothForce(a, b, rest, stiffness, x, f) {
    f.fill(0);
    for (let l = 0; l < a.length; l++) {
        const i = a[l];
        const j = b[l];
        const dx = x[j] - x[i];
        const dy = x[j + 1] - x[i + 1];
        const dz = x[j + 2] - x[i + 2];
        const length = Math.sqrt(dx * dx + dy * dy + dz * dz);
        const pull = (stiffness * (length - rest[l])) / length;
        f[i] += pull * dx;
        f[i + 1] += pull * dy;
        f[i + 2] += pull * dz;
        f[j] -= pull * dx;
        f[j + 1] -= pull * dy;
        f[j + 2] -= pull * dz;
    }
}

function waterForce(a, b, rest, stiffness, x, f) {
    f.fill(0);
    for (let l = 0; l < a.length; l++) {
        const pull = stiffness * (x[b[l]] - x[a[l]]);
        f[a[l]] += pull;
        f[b[l]] -= pull;
    }
}

function kick(h, inverseMass, gravity, axes, f, v) {
    for (let i = 0; i < v.length; i++) v[i] += h * f[i] * inverseMass[i];
    if (gravity !== 0)
        for (let i = axes - 1; i < v.length; i += axes) if (inverseMass[i] !== 0) v[i] += h * gravity;
}

function drift(dt, v, x) {
    for (let i = 0; i < x.length; i++) x[i] += dt * v[i];
}

/** The counterpart of lab.advance(), for a scene with this mass and stiffness. */
export class Plain {
    constructor(lab, mass, stiffness, gravity) {
        const water = gravity === 0;
        const axes = water ? 1 : 3;
        const start = Float64Array.from(lab.positions(1));
        this.x = water ? start.filter((_, i) => i % 3 === 2) : start;
        this.v = new Float64Array(this.x.length);
        this.f = new Float64Array(this.x.length);
        const pinned = pinnedOf(lab);
        this.inverseMass = Float64Array.from(this.x, (_, i) => (pinned[Math.floor(i / axes)] ? 0 : 1 / mass));
        const { ends } = lab;
        this.a = Int32Array.from({ length: lab.links }, (_, l) => axes * ends[2 * l]);
        this.b = Int32Array.from({ length: lab.links }, (_, l) => axes * ends[2 * l + 1]);
        const at = (i, k) => start[3 * i + k];
        this.rest = Float64Array.from({ length: lab.links }, (_, l) =>
            Math.hypot(...[0, 1, 2].map((k) => at(ends[2 * l], k) - at(ends[2 * l + 1], k))),
        );
        Object.assign(this, { axes, stiffness, gravity: -gravity, force: water ? waterForce : clothForce });
        this.force(this.a, this.b, this.rest, stiffness, this.x, this.f);
    }

    advance(dt, n) {
        const { x, v, f, a, b, rest, stiffness, gravity, inverseMass, axes } = this;
        for (let s = 0; s < n; s++) {
            kick(dt / 2, inverseMass, gravity, axes, f, v);
            drift(dt, v, x);
            this.force(a, b, rest, stiffness, x, f);
            kick(dt / 2, inverseMass, gravity, axes, f, v);
        }
    }
}
