// SPDX-License-Identifier: MIT
// The exact solution of a spring over a time step about its target: src/spring/roots.c, exact_formula.h and follow_formula.h
// with the same operations in the same order.
import {
    abs,
    ceil,
    epsilon,
    exponential,
    leastNormal,
    log2,
    max,
    min,
    nearest,
    powerOfTwo,
    productError,
    scaled,
    sineCosine,
    sqrt,
} from "./elementary.js";

const tiny = epsilon / 8; // does not change 1
const nextUlp = epsilon / 2 + (epsilon / 2) * epsilon; // u + 2 u^2 with u = 2^-53

const leastFraction = 2 ** -16; // limits the distance of a landing, so that a short step is a small one

/** n - q d, where q is n/d rounded. */
function remainderOf(n, d, q) {
    const product = q * d;
    return n - product - productError(q, d, product);
}

/** n/d - q for numbers of any size, scaled by powers of two. Which ones does not matter, so log2 need not be exact. */
function restOf(n, d, q) {
    const byD = ceil(log2(d));
    const byQ = q && ceil(log2(q));
    const m = scaled(d, -byD);
    return scaled(remainderOf(scaled(n, -byD - byQ), m, scaled(q, -byQ)) / m, byQ);
}

/** Neither such numbers, nor their products, nor the rounding errors of these overflow or underflow. */
const moderate = (a) => a > powerOfTwo(-400) && a < powerOfTwo(400);

export class Propagator {
    dt;

    constructor(stiffness, damping, mass) {
        const w = stiffness / mass + 0;
        const g = damping / mass + 0;
        const b = g / 2;
        let rest =
            moderate(mass) && moderate(w) && (!g || moderate(g))
                ? (remainderOf(stiffness, mass, w) - b * remainderOf(damping, mass, g)) * (1 / mass)
                : restOf(stiffness, mass, w) - b * restOf(damping, mass, g);
        if (rest - rest !== 0) rest = 0; // it overflows only where b^2 is far larger than w
        this.omega2 = w; // [1/s^2]
        this.b = b; // [1/s]
        // The distance between the roots, sqrt |w - b^2|, scaled by a power of two lest squares overflow or underflow.
        const k = ceil(log2(max(b, sqrt(w), leastNormal)));
        const scale = powerOfTwo(-k);
        const c = b * scale;
        const square = c * c;
        const D = w * scale * scale - square - productError(c, c, square) + rest * scale * scale;
        this.split = sqrt(abs(D)) * powerOfTwo(k);
        this.overdamped = D < 0;
        // [s] times a speed: the distance that a value may still move, or without stiffness, that it moves
        this.reach = 1 / (sqrt(w) || g || Infinity);
    }

    /** Distance and velocity after dt. */
    after(dt, x, v) {
        this.prepare(dt);
        const { half, F, G, H, omega2 } = this;
        return [half * (F * x + H * v), half * (G * v - omega2 * H * x)];
    }

    /** Where a value ends: without stiffness where damping stops it, or where it is if nothing does. */
    restPlace(x, v, target) {
        const place = this.omega2 ? target : x + v / this.b / 2;
        return abs(place) < Infinity ? place : x;
    }

    /** Coefficients for a step of dt: x' = half (F x + H v), v' = half (G v - omega2 H x) about the target. */
    prepare(dt) {
        if (dt === this.dt) return;
        this.dt = dt;
        const { omega2, b, split } = this;
        const angle = split * dt;
        const size = abs(angle);
        let rate = b;
        let F, G, H;
        if (this.overdamped) {
            const [k, e] = exponential(max(-750, -2 * size));
            const power = powerOfTwo(k);
            const part = power * e;
            const fast = b + split;
            rate = omega2 / fast;
            H = size < tiny ? abs(dt) : (1 - power - part) / (2 * split);
            F = 1 + rate * H;
            G = power + part - rate * H;
            if (dt < 0) [rate, F, G, H] = [fast, G, F, -H];
        } else {
            const [sine, cosine] = sineCosine(angle);
            H = size < tiny ? dt : sine * (1 / split);
            F = cosine + b * H;
            G = cosine - b * H;
        }
        // The power of two in two halves, so that a large start times a tiny factor does not underflow early.
        const [k, e] = exponential(max(-1500, min(1500, -rate * dt)));
        const most = nearest(k / 2);
        const power = powerOfTwo(most);
        const other = power + power * e;
        this.half = powerOfTwo(k - most);
        this.F = omega2 ? other * F : 1 / this.half; // without stiffness half F is 1
        this.G = other * G;
        this.H = other * H;
        const decay = rate * dt;
        this.fraction = omega2 && decay > 0 ? min(max(decay, leastFraction), 1) : 0;
        this.angle = this.overdamped ? 0 : size; // [rad] by which the oscillation advances
    }
}

/** Whether rounding would keep the spring from coming closer to its target: the rule of follow_formula.h. */
export function lands(x, target, y, u, fraction, omega2) {
    const half = max(abs(x), abs(target)) / 2;
    const room = (half + half * nextUlp - half) * 2.25 + leastNormal; // 2.25 half ulps
    const distance = abs(y);
    const speed = abs(u) / sqrt(omega2);
    const large = max(distance, speed);
    const ratio = min(distance, speed) / (large || 1);
    return fraction > 0 && large * sqrt(1 + ratio * ratio) * fraction <= room;
}
