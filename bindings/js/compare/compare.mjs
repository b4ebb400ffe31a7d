// SPDX-License-Identifier: MIT
// Prints a table of the errors of spring libraries against the exact solution, and of the time per value: TSV.
import { frameAt, libraries, springstepSet, time } from "./libraries.mjs";

/** Position and velocity after t of x'' = -k x - c x', in the usual formulas. */
function solution(k, c, x, v, t) {
    const b = c / 2;
    const square = k - b * b;
    if (square > 0) {
        const w = Math.sqrt(square);
        const e = Math.exp(-b * t);
        const [sine, cosine] = [Math.sin(w * t) / w, Math.cos(w * t)];
        return [e * (x * cosine + (v + b * x) * sine), e * (v * cosine - (k * x + b * v) * sine)];
    }
    const root = Math.sqrt(-square);
    const [fast, slow] = [b + root, k / (b + root)];
    const [ef, es] = [Math.exp(-fast * t), Math.exp(-slow * t)];
    const a = (v + fast * x) / (fast - slow); // of the slow mode
    return [a * es + (x - a) * ef, -slow * a * es - fast * (x - a) * ef];
}

const frame = 1000 / 60;
const steady = (i) => i * frame;
const hitch = (seconds) => (i) => i * frame + (i >= 6 ? 1000 * seconds - frame : 0); // the sixth frame takes so long
const runs = {
    steady: { stiffness: 170, damping: 26, at: steady },
    hitch_100_ms: { stiffness: 170, damping: 26, at: hitch(0.1) },
    hitch_1_s: { stiffness: 170, damping: 26, at: hitch(1) },
    retarget: { stiffness: 170, damping: 26, at: steady, retarget: 8 },
    retarget_bouncy: { stiffness: 170, damping: 8, at: steady, retarget: 8 },
    damping_5000: { stiffness: 170, damping: 5000, at: steady },
};

/** The largest error of a run of 2 s, of a way of 1. `early`: a frame runs at once after each change of the target. */
async function errorOf(library, { stiffness, damping, at, retarget }, early) {
    const start = time() + 1000;
    await frameAt(start);
    const spring = library.make(stiffness, damping);
    let [x, v, goal, last, most] = [0, 0, 1, 0, 0];
    const aim = async (to) => {
        spring.target(to);
        if (early) await frameAt(time());
    };
    await aim(goal);
    for (let i = 1; at(i) <= 2000; i++) {
        await frameAt(start + at(i));
        [x, v] = solution(stiffness, damping, x - goal, v, (at(i) - last) / 1000);
        x += goal;
        last = at(i);
        const error = Math.abs(spring.value() - x);
        most = error <= most ? most : error; // NaN stays
        if (i === retarget) await aim((goal = -0.5));
    }
    spring.stop();
    await frameAt(start + 3000);
    return most;
}

/** [ns] per value and frame, the least of many rounds, with frames that vary in length. */
async function timeOf(make, count) {
    const perRound = 64;
    const springs = make();
    let least = Infinity;
    for (let round = 0; round < 60; round++) {
        for (const spring of springs) spring.target(1 + (round % 2));
        await frameAt(time());
        const begin = process.hrtime.bigint();
        for (let i = 0; i < perRound; i++) await frameAt(time() + frame + (i % 7) / 16);
        least = Math.min(least, Number(process.hrtime.bigint() - begin) / perRound / count);
    }
    for (const spring of springs) spring.stop();
    await frameAt(time() + 1000);
    return least;
}

const warn = console.warn;
console.warn = () => {}; // some libraries say that values are not finite
const columns = Object.keys(runs);
console.log(`# node ${process.version}, ${process.arch}`);
console.log("# largest error of a way of 1 m within 2 s; time per value and frame, of 100 values");
console.log(["library", "version", ...columns.map((name) => `${name}_error_m`), "time_ns"].join("\t"));
const cell = (number) => (Number.isFinite(number) ? number.toPrecision(3) : "nan");
for (const library of libraries) {
    const errors = [];
    for (const run of Object.values(runs)) {
        const both = [await errorOf(library, run, false), await errorOf(library, run, true)];
        errors.push(both.some(Number.isFinite) ? Math.min(...both.filter(Number.isFinite)) : NaN);
    }
    const count = 100;
    const ns = await timeOf(() => Array.from({ length: count }, () => library.make(170, 26)), count);
    console.log([library.name, library.version, ...errors.map(cell), ns.toPrecision(3)].join("\t"));
}
const many = 1000;
const set = await timeOf(() => [springstepSet(many, 170, 26)], many);
console.log(
    ["springstep, Springs of 1000", libraries[0].version, ...columns.map(() => ""), set.toPrecision(3)].join(
        "\t",
    ),
);
console.warn = warn;
