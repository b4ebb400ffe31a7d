// SPDX-License-Identifier: MIT
// Prints the time per step and value: the least of many rounds, all cases in turn.
import { Spring, Springs } from "../index.js";

const perRound = 20000;
const rounds = 100;
const options = { hertz: 2, restDelta: 0, restSpeed: 0 };
const springs = { oscillating: new Spring(0, { ...options, dampingRatio: 0 }) };
springs.overdamped = new Spring(0, { ...options, dampingRatio: 2 });
const many = new Springs(1000, { ...options, dampingRatio: 0.7 });

/** Frames of about 1/60 s, all equal or all different. */
function steps(spring, varied) {
    for (let i = 0; i < perRound; i++) {
        if (i % 64 === 0) spring.target = i % 128 ? 1 : -1;
        spring.step(1 / 60 + (varied ? (i % 1000) * 1e-6 : 0));
    }
}

const cases = {
    "Spring.step, equal frames": () => steps(springs.oscillating, false),
    "Spring.step, varied frames": () => steps(springs.oscillating, true),
    "Spring.step, varied frames, overdamped": () => steps(springs.overdamped, true),
    "Springs.step of 1000, varied frames": () => {
        many.target.fill(many.target[0] === 100 ? -100 : 100);
        for (let i = 0; i < perRound / 1000; i++) many.step(1 / 60 + i * 1e-6);
    },
};
const least = {};
for (let round = 0; round < rounds; round++)
    for (const [name, run] of Object.entries(cases)) {
        const start = process.hrtime.bigint();
        run();
        const time = Number(process.hrtime.bigint() - start) / perRound;
        least[name] = Math.min(least[name] ?? Infinity, time);
    }
for (const [name, time] of Object.entries(least)) console.log(`${name}: ${time.toFixed(1)} ns per value`);
