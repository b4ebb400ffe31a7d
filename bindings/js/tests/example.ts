// SPDX-License-Identifier: MIT
// A program in TypeScript that uses every declaration of the package, for tests/js.
import { Spring, Springs, VelocityTracker, type SpringOptions, type SpringParameters } from "springstep";
import { animate, animator } from "springstep/animate";
import { linear } from "springstep/css";

const options: SpringOptions = { duration: 0.5, bounce: 0.2, restDelta: 0.01, restSpeed: 0.1 };
const rested: number[] = [];
const spring = new Spring(0, { ...options, clamp: false, onRest: (s: Spring) => rested.push(s.value) });
spring.clamp = true;
spring.velocity = 3;
spring.target = 1;
for (let i = 0; i < 200; i++) spring.step(1 / 60);

const ways: SpringOptions[] = [
    { stiffness: 170, damping: 26, mass: 1 },
    { response: 0.5, dampingFraction: 0.8 },
    { hertz: 2, dampingRatio: 0.7 },
    { halfLife: 0.05, dampingRatio: 0.7 },
    { settling: 0.5, dampingRatio: 0.7, tolerance: 0.01 },
];
for (const way of ways) new Spring(0, way).jump(1);
new Spring(0, { clamp: true });
new Springs(1, { bounce: 0.1 });

// @ts-expect-error: a number is required
const wrong = () => new Spring(0, { hertz: 2, dampingRatio: "none" });
// Each of these throws.
const refused: (() => unknown)[] = [
    // @ts-expect-error: two forms
    () => new Spring(0, { duration: 1, stiffness: 1 }),
    // @ts-expect-error: the second parameter of another form
    () => new Spring(0, { duration: 1, dampingRatio: 1 }),
    // @ts-expect-error
    () => new Spring(0, { hertz: 1, dampingFraction: 1 }),
    // @ts-expect-error
    () => new Spring(0, { hertz: 1, bounce: 0 }),
    // @ts-expect-error
    () => new Spring(0, { response: 1, bounce: 0 }),
    // @ts-expect-error
    () => new Spring(0, { response: 1, duration: 1 }),
    // @ts-expect-error
    () => new Spring(0, { halfLife: 1, damping: 1 }),
    // @ts-expect-error
    () => new Spring(0, { duration: 1, mass: 1 }),
    // @ts-expect-error
    () => new Spring(0, { stiffness: 1, damping: 1, bounce: 0 }),
    // @ts-expect-error: half of a form
    () => new Spring(0, { stiffness: 1 }),
    // @ts-expect-error
    () => new Spring(0, { dampingRatio: 1 }),
    // @ts-expect-error
    () => new Spring(0, { mass: 1 }),
    // @ts-expect-error: of another form
    () => new Spring(0, { hertz: 1, tolerance: 0.1 }),
    // @ts-expect-error: a number is required
    () => new Spring(0, { stiffness: [1], damping: 1 }),
    // @ts-expect-error: two forms
    () => new Springs(1, { stiffness: [1], damping: 1, hertz: [1] }),
    // @ts-expect-error: a parameter of no form
    () => new Spring(0).set({ bouncy: 1 }),
    // @ts-expect-error
    () => new Spring(0).set({ hertz: 1, bounce: 0 }),
    // @ts-expect-error: options that an easing does not have
    () => linear({ ...options, clamp: true }),
    // @ts-expect-error
    () => linear(options),
    // @ts-expect-error: one call for each spring
    () => animate([spring], () => {}),
    // @ts-expect-error
    () => animate(spring, () => {}, { reducedMotions: "run" }),
    // @ts-expect-error: no such property
    () => (new Spring(0).stiffness = 300),
];
const accepted = refused.filter((run) => {
    try {
        run();
    } catch {
        return false;
    }
    return true;
});

// @ts-expect-error: the target of a set is filled, not replaced
const assign = (s: Springs) => (s.target = new Float64Array(2));

const many = new Springs(2, { hertz: 2, dampingRatio: 0.7 });
many.target.set([1, -1]);
let moving: number = many.step(1 / 60);
for (let i = 0; i < 200; i++) moving = many.step(1 / 60);

spring.onRest = null;
const timer: { callback: ((time: number) => void) | null } = { callback: null };
const run = animator({ request: (frame) => (timer.callback = frame) });
const drawn: number[] = [];
const stop: () => void = run(spring, (value, { velocity }) => drawn.push(value + 0 * velocity));
run(many, (values: Float64Array) => drawn.push(0 * values[0]!), { reducedMotion: "run" });
many.set({ stiffness: [100, 200], damping: 20 });
many.set({ damping: 30, clamp: true });
many.onRest = (i, springs) => springs.settled(i);
spring.set({ stiffness: 300, damping: 20 });
spring.set({ damping: 25 });
spring.set({ restDelta: 0.02 });
spring.set(options);
const feel: SpringParameters = { duration: 0.5, bounce: 0.2 };
spring.set(feel);
const tracker = new VelocityTracker();
tracker.add(3, 0);
spring.release(tracker.velocity(16), 3);
spring.targetVelocity = 0;
for (let time = 0; timer.callback && time < 20000; time += 16) {
    const { callback } = timer;
    timer.callback = null;
    callback(time);
}
stop();
const settled: Promise<void> = spring.finished;
await settled;
const { duration, easing } = linear(feel, 0);
const good =
    spring.value === 3 &&
    spring.settlingTime() === 0 &&
    drawn.length > 5 &&
    duration > 500 &&
    easing.length > 50;
if (!good || typeof animate !== "function") throw new Error("the animation does not end");

console.log(rested.join(), spring.settled && assign.length + wrong.length + accepted.length === 1, moving);
