// SPDX-License-Identifier: MIT
// Prints the table of docs/javascript.md: errors of spring libraries against the exact solution, and the time per value. npm
// installs the libraries here first.
//
// usage: node bindings/js/compare.mjs
import { execFileSync } from "node:child_process";
import { fileURLToPath } from "node:url";
import { Spring, Springs } from "./index.js";

const versions = { "@react-spring/core": "10.1.2", motion: "14.14.0", popmotion: "11.0.5" };
Object.assign(versions, { wobble: "1.5.1", rebound: "0.1.0" });
const packages = Object.entries({ ...versions, react: "19.3.1" }).map((each) => each.join("@"));
execFileSync(
    "npm",
    ["install", "--no-save", "--no-package-lock", "--ignore-scripts", "--no-audit", "--no-fund", ...packages],
    { cwd: fileURLToPath(new URL(".", import.meta.url)), stdio: ["ignore", "ignore", "inherit"] },
);

// The clock that all libraries see.
let now = 1000; // [ms]
let queue = [];
globalThis.performance.now = () => now;
Date.now = () => Math.floor(now);
globalThis.requestAnimationFrame = (run) => queue.push(run);
globalThis.cancelAnimationFrame = () => {};
globalThis.window = globalThis; // some libraries look for functions there
console.warn = () => {}; // some libraries say that values are not finite

/** A frame at a time: what is waiting for it runs, then what that has left for later. */
async function frameAt(ms) {
    now = ms;
    const due = queue;
    queue = [];
    for (const run of due) run(now);
    await null;
    await null;
}

/** Calls step(ms) in every frame with the time since the last one; returns a function that stops it. */
function stepped(step) {
    let [last, stopped] = [now, false];
    const run = (ms) => {
        if (stopped) return;
        step(ms - last);
        last = ms;
        requestAnimationFrame(run);
    };
    requestAnimationFrame(run);
    return () => (stopped = true);
}

const { SpringValue } = await import("@react-spring/core");
const { springValue } = await import("motion");
const { animate, velocityPerSecond } = await import("popmotion");
const { Spring: Wobble } = await import("wobble");
const { default: Rebound } = await import("rebound");

// Thresholds at which a spring counts as settled are tiny, so that they do not count as errors.
const rest = 1e-13;
const own = { restDelta: 0, restSpeed: 0 };

/** Springs with a stiffness and a damping. */
const libraries = {
    springstep(stiffness, damping) {
        const spring = new Spring(0, { stiffness, damping, ...own });
        const stop = stepped((ms) => spring.step(ms / 1000));
        return { target: (to) => (spring.target = to), value: () => spring.value, stop };
    },
    "react-spring"(tension, friction) {
        const spring = new SpringValue(0);
        const config = { tension, friction, precision: rest, restVelocity: rest };
        return {
            target: (to) => spring.start(to, { config }),
            value: () => spring.get(),
            stop: () => spring.stop(),
        };
    },
    motion(stiffness, damping) {
        const value = springValue(0, { stiffness, damping, restDelta: rest, restSpeed: rest });
        return { target: (to) => value.set(to), value: () => value.get(), stop: () => value.stop() };
    },
    popmotion(stiffness, damping) {
        let [value, velocity, at, running] = [0, 0, now, null];
        const target = (to) => {
            running?.stop();
            running = animate({
                ...{ from: value, to, velocity, stiffness, damping, restDelta: rest, restSpeed: rest },
                onUpdate(next) {
                    velocity = now > at ? velocityPerSecond(next - value, now - at) : velocity;
                    [value, at] = [next, now];
                },
            });
        };
        return { target, value: () => value, stop: () => running?.stop() };
    },
    wobble(stiffness, damping) {
        const spring = new Wobble({
            ...{ fromValue: 0, toValue: 0, stiffness, damping, mass: 1, allowsOverdamping: true },
            ...{ restVelocityThreshold: rest, restDisplacementThreshold: rest },
        });
        const target = (toValue) => spring.updateConfig({ toValue }).start();
        return { target, value: () => spring.currentValue, stop: () => spring.stop() };
    },
    rebound(tension, friction) {
        const looper = new Rebound.SteppingSimulationLooper();
        const config = new Rebound.SpringConfig(tension, friction);
        const spring = new Rebound.SpringSystem(looper).createSpringWithConfig(config);
        spring.setRestSpeedThreshold(rest);
        spring.setRestDisplacementThreshold(rest);
        const stop = stepped((ms) => looper.step(ms));
        return { target: (to) => spring.setEndValue(to), value: () => spring.getCurrentValue(), stop };
    },
};

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
const runs = {
    "60 Hz": {},
    "a frame of 0.1 s": { hitch: 100 }, // the sixth frame takes so long [ms]
    "a frame of 1 s": { hitch: 1000 },
    "new target": { retarget: 8 },
    "new target, damping 8": { damping: 8, retarget: 8 },
    "damping 5000": { damping: 5000 },
};

/** The largest error of a run of 2 s, of a way of 1. `early`: a frame runs at once after each change of the target. */
async function errorOf(make, { stiffness = 170, damping = 26, hitch = frame, retarget }, early) {
    const at = (i) => i * frame + (i >= 6 ? hitch - frame : 0);
    const start = now + 1000;
    await frameAt(start);
    const spring = make(stiffness, damping);
    let [x, v, goal, last, most] = [0, 0, 1, 0, 0];
    const aim = async (to) => {
        spring.target(to);
        if (early) await frameAt(now);
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
async function timeOf(springs, count) {
    const perRound = 64;
    let least = Infinity;
    for (let round = 0; round < 60; round++) {
        for (const spring of springs) spring.target(1 + (round % 2));
        await frameAt(now);
        const begin = process.hrtime.bigint();
        for (let i = 0; i < perRound; i++) await frameAt(now + frame + (i % 7) / 16);
        least = Math.min(least, Number(process.hrtime.bigint() - begin) / perRound / count);
    }
    for (const spring of springs) spring.stop();
    await frameAt(now + 1000);
    return `${+least.toPrecision(2)}`;
}

const row = (...cells) => console.log(`| ${cells.join(" | ")} |`);
const columns = Object.keys(runs);
row("", ...columns, "ns per value");
console.log(`|${"---|".repeat(columns.length + 2)}`);
for (const [name, make] of Object.entries(libraries)) {
    const cells = [];
    for (const run of Object.values(runs)) {
        const both = [await errorOf(make, run, false), await errorOf(make, run, true)].filter(
            Number.isFinite,
        );
        cells.push(both.length > 0 ? Math.min(...both).toExponential(1) : "not finite");
    }
    const springs = Array.from({ length: 100 }, () => make(170, 26));
    const version = versions[name] ?? versions[`@${name}/core`];
    row(version ? `${name} ${version}` : name, ...cells, await timeOf(springs, springs.length));
}
const many = new Springs(1000, { stiffness: 170, damping: 26, ...own });
const set = { target: (to) => many.target.fill(to), stop: stepped((ms) => many.step(ms / 1000)) };
row("springstep, Springs of 1000", ...columns.map(() => ""), await timeOf([set], 1000));
