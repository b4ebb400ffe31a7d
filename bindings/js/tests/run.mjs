// SPDX-License-Identifier: MIT
// The package for JavaScript: bits, landing, errors, callbacks. Prints TAP.
//     run.mjs JS_STATES VERSION.H [SPRINGS]     so many springs are compared with C, instead of 100000
import assert from "node:assert";
import { mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";
import { Spring, Springs } from "../index.js";
import { compareSets, compareSingle } from "./compare.mjs";
import { logarithmic, slowRate, uniform, usual } from "./random.mjs";
import { done, note, refused, test } from "./tap.mjs";

const [program, versionHeader, springs = "100000"] = process.argv.slice(2);
const count = Number(springs);
const local = (name) => readFileSync(new URL(`../${name}`, import.meta.url), "utf8");

await test("version and licence are those of the library", () => {
    const version = /SPRING_VERSION "(.*)"/.exec(readFileSync(versionHeader, "utf8"))[1];
    assert.strictEqual(JSON.parse(local("package.json")).version, version);
    assert.strictEqual(local("LICENSE"), local("../../LICENSE"));
});

await test("single springs have the bits of spring_follow()", () => {
    const { different, stepped, rested } = compareSingle(program, count);
    note(`${different} of ${count} springs differ, of ${stepped} steps ${rested} end at rest`);
    assert.strictEqual(different, 0);
    assert(stepped > 3 * count && rested > count / 4, "few are invalid, many land");
});

await test("sets of springs have the bits of spring_batch_follow()", () => {
    const { different, miscounted } = compareSets(program, count);
    note(`${different} of ${count} springs differ`);
    assert.strictEqual(different, 0);
    assert.strictEqual(miscounted, 0, "how many move, or whether one fails");
});

await test("every spring lands exactly on its target", () => {
    let longest = 0;
    for (let i = 0; i < Math.min(count / 50, 20000); i++) {
        const { stiffness, damping, mass, omega, zeta } = usual();
        const slow = slowRate(omega, zeta);
        const dt = [1 / 60, 1 / 240, 1 / logarithmic(30, 240)][i % 3];
        const target = uniform(-1000, 1000);
        const s = new Spring(uniform(-1000, 1000), { stiffness, damping, mass, restDelta: 0, restSpeed: 0 });
        s.velocity = uniform(-100, 100) * omega;
        s.target = target;
        let frames = 0;
        for (; !s.settled && frames * dt * slow < 200; frames++) s.step(dt);
        assert(s.settled && s.value === target && s.velocity === 0, `after ${frames} frames`);
        longest = Math.max(longest, frames * dt * slow);
    }
    note(`the longest landing took ${longest.toFixed(1)} decay times`);
});

await test("a step as short as a rounding error does not move a value to its target", () => {
    const options = { duration: 5, restDelta: 0, restSpeed: 0 };
    const s = new Spring(0, options);
    const set = new Springs(1, options);
    s.target = set.target[0] = 1000;
    let t = 0;
    for (let i = 0; i < 10; i++, t += 0.1) {
        s.step(0.1);
        set.step(0.1);
    }
    const { value } = s;
    note(`a step of ${(1 - t).toPrecision(2)} s from ${value} to ${s.step(1 - t)}`);
    assert.strictEqual(set.step(1 - t), 1);
    assert(Math.abs(s.value - value) < 1e-12 && set.value[0] === s.value);
});

/** Imports a program of README as users would. */
async function imported(program) {
    const folder = mkdtempSync(join(tmpdir(), "springstep-"));
    mkdirSync(join(folder, "node_modules"));
    symlinkSync(fileURLToPath(new URL("..", import.meta.url)), join(folder, "node_modules/springstep"));
    writeFileSync(join(folder, "program.mjs"), program);
    await import(pathToFileURL(join(folder, "program.mjs")));
    rmSync(folder, { recursive: true });
}

await test("the loop of README: started by a click, again after rest, first frames before the click", async () => {
    let time = 0; // [ms]
    let callback = null;
    const { performance } = globalThis;
    Object.defineProperty(globalThis, "performance", { value: { now: () => time }, configurable: true });
    globalThis.element = { style: {} };
    globalThis.requestAnimationFrame = (frame) => (callback = frame);
    await imported(/```js\n([^]*?)```/.exec(local("README.md"))[1]);
    const { style } = globalThis.element;
    let earlier = 0;
    for (let click = 0; click < 40; click++) {
        time += uniform(0, 30000);
        const [from, to] = click % 2 ? [100, 0] : [0, 100];
        const reference = new Spring(from, { duration: 0.5, bounce: 0.2 });
        reference.target = to;
        globalThis.element.onclick();
        let before = time;
        time += uniform(-16, 16);
        earlier += time < before;
        let frames = 0;
        for (; callback; frames++) {
            const frame = callback;
            callback = null;
            frame(time);
            reference.step(Math.max(0, time - before) / 1000);
            assert.strictEqual(style.translate, `${reference.value}px`, `click ${click}, frame ${frames}`);
            before = time;
            time += 1000 / 60;
        }
        assert(reference.settled && frames > 30, `the loop stopped after ${frames} frames`);
        const again = reference.step(1 / 60); // no further frame is due
        assert.strictEqual(again, to);
    }
    assert(earlier > 10, `${earlier} first frames are earlier than the click`);
    Object.defineProperty(globalThis, "performance", { value: performance, configurable: true });
});

await test("a motion of any size settles after the same frames, without a jump", () => {
    const frames = new Set();
    for (let i = 0; i < 200; i++) {
        const size = (i % 2 ? 1 : -1) * 2 ** Math.round(uniform(-40, 40));
        const one = new Spring(0, { duration: 0.4, bounce: 0.3 });
        const many = new Springs(1, { duration: 0.4, bounce: 0.3 });
        one.target = many.target[0] = size;
        let n = 0;
        let last = 0;
        for (; !one.settled && n < 1000; n++) {
            last = one.value;
            one.target = size; // the same target in every frame
            const moving = many.step(1 / 60);
            one.step(1 / 60);
            assert.strictEqual(many.value[0], one.value);
            assert.strictEqual(moving, one.settled ? 0 : 1);
        }
        assert(Math.abs(size - last) <= 5e-4 * Math.abs(size), `a last step of ${(size - last) / size}`);
        frames.add(n);
    }
    assert(frames.size === 1 && [...frames][0] < 120, `${[...frames]} frames`);
    const flicked = new Spring(3, { hertz: 2, dampingRatio: 0.5 });
    flicked.velocity = 1e-3;
    let most = 0;
    for (let n = 0; !flicked.settled; n++) most = Math.max(most, flicked.step(1 / 60) - 3, n > 300 ? NaN : 0);
    assert(most > 3e-5 && flicked.value === 3, `a velocity moves the value by ${most}`);
});

await test("without stiffness a value settles where damping stops it", () => {
    for (const [velocity, damping] of [
        [1000, 4],
        [-1e-3, 0.5],
    ]) {
        let rested = 0;
        const s = new Spring(7, { stiffness: 0, damping, onRest: () => rested++ });
        s.velocity = velocity;
        for (let t = 0; t < 60 && !s.settled; t += 1 / 60) s.step(1 / 60);
        assert(s.settled && s.velocity === 0 && rested === 1);
        const way = velocity / damping;
        assert(Math.abs(s.value - 7 - way) <= 1.001e-4 * Math.abs(way), `${s.value - 7}, not ${way}`);
    }
});

await test("a property that a spring does not have cannot be set", () => {
    for (const spring of [new Spring(0), new Springs(1)])
        assert.throws(() => (spring.stiffness = 300), TypeError);
    class Mine extends Spring {
        name = "mine";
    }
    assert.strictEqual(new Mine(3).name, "mine");
});

await test("parameters are those of C", () => {
    // One step of 0.1 s from rest at 0 to 1, against stiffness and damping as src/spring/params.c computes them.
    const after = (options) => {
        const s = new Spring(0, options);
        s.target = 1;
        return s.step(0.1);
    };
    const of = (omega, ratio) => after({ stiffness: omega * omega, damping: 2 * ratio * omega });
    const twoPi = 2 * Math.PI;
    assert.strictEqual(after({ response: 0.3, dampingFraction: 0.7 }), of(twoPi / 0.3, 0.7));
    assert.strictEqual(after({ duration: 0.5, bounce: 0.25 }), of(twoPi / 0.5, 0.75));
    assert.strictEqual(after({ duration: 0.5, bounce: -0.3 }), of(twoPi / 0.5, 1 / 0.7));
    assert.strictEqual(after({ hertz: 2, dampingRatio: 0.7 }), of(twoPi * 2, 0.7));
    assert.strictEqual(after({ halfLife: 0.05, dampingRatio: 0.5 }), of(Math.LN2 / 0.05 / 0.5, 0.5));
    const rate = 1 / (2 + Math.sqrt(1) * Math.sqrt(3));
    assert.strictEqual(after({ halfLife: 0.05, dampingRatio: 2 }), of(Math.LN2 / 0.05 / rate, 2));
    for (const options of [undefined, {}, { clamp: true }, { restDelta: 1e-9 }, { bounce: 0 }])
        assert.strictEqual(after({ duration: 0.5 }), after(options), "the default");
    assert.strictEqual(after({ stiffness: 40, damping: 3 }), after({ stiffness: 80, damping: 6, mass: 2 }));
});

await test("onRest is called once each time a spring settles", () => {
    const rested = [];
    const s = new Spring(0, { duration: 0.3, onRest: (spring) => rested.push(spring.value) });
    const run = () => {
        for (let i = 0; i < 200; i++) s.step(1 / 60);
    };
    run();
    assert.deepStrictEqual(rested, [], "it was at rest");
    s.target = 5;
    run();
    assert.deepStrictEqual(rested, [5]);
    s.target = 5;
    assert(!s.settled, "until the next step");
    run();
    assert.deepStrictEqual(rested, [5, 5], "a new target that equals the value");
    s.target = 6;
    s.jump(9);
    run();
    assert.deepStrictEqual([rested, s.value, s.target, s.velocity, s.settled], [[5, 5], 9, 9, 0, true]);
    s.velocity = 3;
    run();
    assert.deepStrictEqual(rested, [5, 5, 9]);
    s.onRest = (spring) => (spring.target = 1);
    s.target = 0;
    run();
    assert.deepStrictEqual([s.value, s.settled], [1, true], "a callback may set a new target");
});

await test("clamp stops at the target, in long steps too", () => {
    for (const dt of [1 / 240, 1 / 60, 0.1, 0.5, 1, 1.5, 2]) {
        const s = new Spring(0, { hertz: 1, dampingRatio: 0.1, clamp: true });
        s.target = 10;
        for (let t = 0; t < 2; t += dt) {
            s.step(dt);
            assert(s.value <= 10, `${s.value} after ${t} s`);
        }
        assert.deepStrictEqual([s.value, s.velocity, s.settled], [10, 0, true], `dt ${dt}`);
    }
    const flicked = new Spring(4, { hertz: 1, dampingRatio: 0.1, clamp: true });
    for (const velocity of [-20, 20]) {
        flicked.velocity = velocity;
        for (let i = 0; i < 60; i++)
            assert.strictEqual(flicked.step(1 / 60), 4, "a value on its target stays");
        assert(flicked.settled && flicked.velocity === 0);
    }
    const back = new Spring(0, { hertz: 1, dampingRatio: 0.1, clamp: true });
    back.target = 10;
    back.step(-0.4);
    assert(back.value > 11 && !back.settled, "not backwards");
    const free = new Spring(0, { hertz: 1, dampingRatio: 0.1 });
    free.target = 10;
    for (let i = 0; i < 36; i++) free.step(1 / 60);
    assert(free.value > 11, "without it the value overshoots");
});

await test("errors name field and value", () => {
    const spring = (options) => () => new Spring(0, options);
    const good = { stiffness: 40, damping: 3 };
    refused(
        spring({ ...good, stiffness: NaN }),
        "RangeError: stiffness must be a finite number >= 0, got NaN",
    );
    refused(spring({ ...good, damping: -1 }), "RangeError: damping must be a finite number >= 0, got -1");
    refused(spring({ stiffness: 1 }), "TypeError: damping must be a finite number >= 0, got undefined");
    refused(spring({ ...good, mass: 0 }), "RangeError: mass must be a finite number > 0, got 0");
    refused(
        spring({ ...good, mass: 1e-310 }),
        "RangeError: stiffness / mass must be a finite number, got Infinity",
    );
    refused(
        spring({ ...good, stiffness: "40" }),
        'TypeError: stiffness must be a finite number >= 0, got "40"',
    );
    refused(spring({ response: 0 }), "RangeError: response must be a finite number > 0, got 0");
    refused(
        spring({ response: 1, dampingFraction: -1 }),
        "RangeError: dampingFraction must be a finite number >= 0, got -1",
    );
    refused(spring({ duration: -1 }), "RangeError: duration must be a finite number > 0, got -1");
    refused(spring({ duration: 1, bounce: -1 }), "RangeError: bounce must be a number > -1 and <= 1, got -1");
    refused(spring({ hertz: Infinity }), "RangeError: hertz must be a finite number > 0, got Infinity");
    refused(spring({ hertz: 0 }), "RangeError: hertz must be a finite number > 0, got 0");
    refused(spring({ hertz: 1e200 }), "RangeError: stiffness must be a finite number >= 0, got Infinity");
    refused(spring({ hertz: 1e-160 }), "RangeError: stiffness must be no denormal number, got...");
    refused(
        spring({ halfLife: 1, dampingRatio: 0 }),
        "RangeError: dampingRatio must be a finite number > 0, got 0",
    );
    const oneOf = "TypeError: options must have one of stiffness, response, duration, hertz, halfLife";
    refused(spring({ damping: 3 }), oneOf);
    refused(spring({ hertz: 1, bounce: 0 }), "TypeError: the option bounce does not go with hertz");
    refused(spring({ hertz: 1, duration: 1 }), "TypeError: the option duration does not go with hertz");
    assert.throws(spring(null), TypeError);
    refused(spring(3), oneOf);
    refused(spring({ ...good, restDelta: -1 }), "RangeError: restDelta must be a finite number >= 0, got -1");
    refused(
        spring({ ...good, restSpeed: NaN }),
        "RangeError: restSpeed must be a finite number >= 0, got NaN",
    );
    refused(spring({ ...good, onRest: 3 }), "TypeError: onRest must be a function or null, got 3");
    refused(() => new Spring(NaN), "RangeError: value must be a finite number, got NaN");
    const s = new Spring(1, good);
    s.velocity = 2;
    for (const name of ["target", "velocity"])
        refused(() => (s[name] = NaN), `RangeError: ${name} must be a finite number, got NaN`);
    refused(() => s.step(NaN), "RangeError: dt must be a finite number, got NaN");
    refused(() => s.step(), "TypeError: dt must be a finite number, got undefined");
    refused(() => s.jump(Infinity), "RangeError: value must be a finite number, got Infinity");
    refused(() => s.step(-1e6), "RangeError: value or velocity overflows");
    assert.deepStrictEqual([s.value, s.velocity, s.target], [1, 2, 1], "nothing has changed");
    refused(() => new Springs(-1), "RangeError: count must be an integer >= 0, got -1");
    refused(
        () => new Springs(2, { ...good, clamp: true }),
        "TypeError: the option clamp does not go with stiffness",
    );
    const many = new Springs(3, good);
    many.target.set([1, NaN, 1]);
    refused(() => many.step(0.1), "RangeError: target[1] must be a finite number, got NaN");
    assert(many.value[0] > 0 && many.value[1] === 0 && many.value[2] > 0, "the others have moved");
    many.target.set([1, -1e308, 1]);
    many.value[1] = 1.5e308;
    refused(() => many.step(0.1), "RangeError: value[1] or velocity[1] overflows");
});

done();
