// SPDX-License-Identifier: MIT
// Wind, rain, and a ball falling into the water.
import { Spring } from "springstep";
import { peakOf } from "../../../tools/scenes/presets.mjs";

/** Pseudorandom numbers from 0 to 1, the same in every run: a 32-bit xorshift generator. */
export function random(seed) {
    let state = seed ^ 0x9e3779b9 || 1;
    return () => {
        state ^= state << 13;
        state ^= state >>> 17;
        state ^= state << 5;
        return (state >>> 0) / 2 ** 32;
    };
}

/** A drop has the momentum of one particle at 10 m/s. */
export const peakOfDrop = (mass) => peakOf(10 * mass);

/** A number in [-1, 1] that changes smoothly within a second. */
function noise(t, stream) {
    const whole = Math.floor(t);
    const part = t - whole;
    const at = (second) => {
        const next = random(Math.imul(stream + second, 0x85ebca6b));
        next();
        return next();
    };
    const first = at(whole);
    return 2 * (first + part * part * (3 - 2 * part) * (at(whole + 1) - first)) - 1;
}

/** Adds the pressure of a gusty wind on a sheet, F = rho/2 |w| (w n) A; n and A are from the cells around a particle. */
export function wind(speed, [columns, rows], t, position, force) {
    const density = 1.2; // [kg/m^3]
    const gust = 0.75 + 0.25 * noise(1.3 * t, 1000);
    const w = [speed * 0.35 * noise(0.7 * t, 2000), speed * gust, speed * 0.3 * noise(0.9 * t, 3000)];
    const strength = 0.5 * density * Math.hypot(...w);
    const [x, y, z] = position;
    const [fx, fy, fz] = force;
    for (let j = 0, at = 0; j < rows; j++)
        for (let i = 0; i < columns; i++, at++) {
            const left = i > 0 ? at - 1 : at;
            const right = i + 1 < columns ? at + 1 : at;
            const up = j > 0 ? at - columns : at;
            const down = j + 1 < rows ? at + columns : at;
            const [ux, uy, uz] = [x[right] - x[left], y[right] - y[left], z[right] - z[left]];
            const [vx, vy, vz] = [x[down] - x[up], y[down] - y[up], z[down] - z[up]];
            const ax = 0.25 * (uy * vz - uz * vy);
            const ay = 0.25 * (uz * vx - ux * vz);
            const az = 0.25 * (ux * vy - uy * vx);
            const size = Math.sqrt(ax * ax + ay * ay + az * az);
            const pressure = size > 0 ? (strength * (w[0] * ax + w[1] * ay + w[2] * az)) / size : 0;
            fx[at] += pressure * ax;
            fy[at] += pressure * ay;
            fz[at] += pressure * az;
        }
}

const gravity = 9.81; // [m/s^2]

/** A ball that falls, hits the water, and floats: a single spring whose target is the height of the water. */
export class Ball {
    constructor(lab, x, y, height) {
        Object.assign(this, { lab, x, y, height, radius: 0.28, mass: 12, velocity: 0, spring: null });
    }

    advance(duration) {
        const level = this.lab.level(this.x, this.y);
        if (this.spring) {
            this.spring.target = level + 0.35 * this.radius - gravity / (2 * Math.PI * 4) ** 2;
            this.height = this.spring.step(duration);
            return;
        }
        this.height += duration * (this.velocity - 0.5 * gravity * duration);
        this.velocity -= gravity * duration;
        if (this.height < level + 0.5 * this.radius) this.splash();
    }

    /** Transfers the momentum of the ball to the water. */
    splash() {
        const area = Math.PI * this.radius ** 2;
        this.lab.poke(this.x, this.y, peakOf(-this.mass * this.velocity), area);
        this.spring = new Spring(this.height, { hertz: 4, dampingRatio: 0.2, restDelta: 0, restSpeed: 0 });
        this.spring.velocity = 0.3 * this.velocity;
    }

    /** [x, y, height, radius] */
    get place() {
        return [this.x, this.y, this.height, this.radius];
    }
}
