// SPDX-License-Identifier: MIT
// Springs of other libraries behind one interface, and the clock that all of them see.
//
// A library gets { name, version, make(stiffness, damping) }, and what it makes has target(to) and a value. Thresholds at which a
// spring counts as settled are tiny, so that they do not count as errors.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

let now = 1000; // [ms]
let queue = [];
globalThis.performance.now = () => now;
Date.now = () => Math.floor(now);
globalThis.requestAnimationFrame = (run) => queue.push(run);
globalThis.cancelAnimationFrame = () => {};
globalThis.window = globalThis; // some libraries look for functions there

export const time = () => now;

/** A frame at a time: what is waiting for it runs, then what that has left for later. */
export async function frameAt(ms) {
    now = ms;
    const due = queue;
    queue = [];
    for (const run of due) run(now);
    for (const step of steppers) step(now);
    await null;
    await null;
}

const steppers = new Set(); // of libraries that are called once a frame
const rest = 1e-13;

const require = createRequire(import.meta.url);

function versionOf(name) {
    for (const folder of require.resolve.paths(name))
        try {
            return JSON.parse(readFileSync(join(folder, name, "package.json"))).version;
        } catch {
            // not in this folder
        }
    throw new Error(`${name} is not installed`);
}

const { Spring, Springs } = await import("../index.js");

/** `step` runs once a frame, with the seconds since the last. */
function stepped(step) {
    let last = now;
    const run = (ms) => {
        if (ms > last) step((ms - last) / 1000);
        last = ms;
    };
    steppers.add(run);
    return () => steppers.delete(run);
}

function springstep() {
    return {
        name: "springstep",
        version: JSON.parse(readFileSync(new URL("../package.json", import.meta.url))).version,
        make(stiffness, damping) {
            const spring = new Spring(0, { stiffness, damping, restDelta: 0, restSpeed: 0 });
            const stop = stepped((dt) => spring.step(dt));
            return { target: (to) => (spring.target = to), value: () => spring.value, stop };
        },
    };
}

/** Not for errors: many values with the same parameters. */
export function springstepSet(count, stiffness, damping) {
    const springs = new Springs(count, { stiffness, damping, restDelta: 0, restSpeed: 0 });
    const stop = stepped((dt) => springs.step(dt));
    return { target: (to) => springs.target.fill(to), stop };
}

async function reactSpring() {
    const { SpringValue } = await import("@react-spring/core");
    return {
        name: "react-spring",
        version: versionOf("@react-spring/core"),
        make(tension, friction) {
            const spring = new SpringValue(0);
            const config = { tension, friction, precision: rest, restVelocity: rest };
            return {
                target: (to) => spring.start(to, { config }),
                value: () => spring.get(),
                stop: () => spring.stop(),
            };
        },
    };
}

async function motion() {
    const { springValue } = await import("motion");
    return {
        name: "motion",
        version: versionOf("motion"),
        make(stiffness, damping) {
            const value = springValue(0, { stiffness, damping, restDelta: rest, restSpeed: rest });
            return { target: (to) => value.set(to), value: () => value.get(), stop: () => value.stop() };
        },
    };
}

async function popmotion() {
    const { animate, velocityPerSecond } = await import("popmotion");
    return {
        name: "popmotion",
        version: versionOf("popmotion"),
        make(stiffness, damping) {
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
    };
}

async function wobble() {
    const { Spring: Wobble } = await import("wobble");
    return {
        name: "wobble",
        version: versionOf("wobble"),
        make(stiffness, damping) {
            const spring = new Wobble({
                ...{ fromValue: 0, toValue: 0, stiffness, damping, mass: 1, allowsOverdamping: true },
                ...{ restVelocityThreshold: rest, restDisplacementThreshold: rest },
            });
            const target = (toValue) => spring.updateConfig({ toValue }).start();
            return { target, value: () => spring.currentValue, stop: () => spring.stop() };
        },
    };
}

async function rebound() {
    const { default: library } = await import("rebound");
    return {
        name: "rebound",
        version: versionOf("rebound"),
        make(tension, friction) {
            const looper = new library.SteppingSimulationLooper();
            const system = new library.SpringSystem(looper);
            const spring = system.createSpringWithConfig(new library.SpringConfig(tension, friction));
            spring.setRestSpeedThreshold(rest);
            spring.setRestDisplacementThreshold(rest);
            let last = now;
            const run = (ms) => {
                looper.step(ms - last);
                last = ms;
            };
            steppers.add(run);
            return {
                target: (to) => spring.setEndValue(to),
                value: () => spring.getCurrentValue(),
                stop: () => steppers.delete(run),
            };
        },
    };
}

export const libraries = [
    springstep(),
    ...(await Promise.all([reactSpring, motion, popmotion, wobble, rebound].map((get) => get()))),
];
