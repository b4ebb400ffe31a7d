// SPDX-License-Identifier: MIT
// The package for JavaScript: bits, landing, errors, callbacks. Prints TAP.
//     run.mjs JS_STATES VERSION.H [SPRINGS]     so many springs are compared with C, instead of 100000
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { inspect } from "node:util";
import { animate, animator } from "../animate.js";
import { linear } from "../css.js";
import { Spring, Springs, VelocityTracker } from "../index.js";
import { compareSets, compareSettling, compareSingle, compareSteered } from "./compare.mjs";
import { bits, logarithmic, slowRate, uniform, usual } from "./random.mjs";
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

await test("targets with velocities and new parameters have the bits of spring_follow()", () => {
    const springs = Math.max(count / 20, 20000);
    const { one, many, landed, steps } = compareSteered(program, springs);
    note(`of ${steps} steps ${one} of Spring and ${many} of Springs differ, ${landed} end on a target`);
    assert.deepStrictEqual([one, many], [0, 0]);
    assert(landed > steps / 20, "many land");
});

await test("parameters of a settling time are those of spring_params_settling()", () => {
    assert.strictEqual(compareSettling(program, 5000), 0);
    const spring = new Spring(1, { settling: 0.7, dampingRatio: 0.4, restDelta: 1e-3, restSpeed: 1e9 });
    spring.target = 0;
    const time = spring.settlingTime();
    assert(Math.abs(time - 0.7) < 1e-12, `${time}`);
});

/** A spring in motion, in a frame of its own length. */
function moving() {
    const { stiffness, damping, mass, omega } = usual();
    const limits = bits() % 2 ? {} : { restDelta: logarithmic(1e-4, 1), restSpeed: logarithmic(1e-4, 1) };
    const free = bits() % 10 === 0 ? { stiffness: 0 } : {};
    const spring = new Spring(uniform(-1, 1), {
        stiffness,
        damping,
        mass,
        ...free,
        ...limits,
        clamp: bits() % 3 === 0,
    });
    spring.target = uniform(-1, 1);
    spring.velocity = uniform(-1, 1) * omega * (bits() % 4 ? 1 : 10);
    return spring;
}

await test("a spring settles in the first frame after settlingTime(), at any frame rate", () => {
    let clamped = 0;
    for (let i = 0; i < 2000; i++) {
        const spring = moving();
        const time = spring.settlingTime();
        const dt = Math.max(1 / uniform(30, 240), time / 1000);
        let frames = 0;
        for (; !spring.settled && frames < 1100; frames++) {
            if (frames % 10 === 0) {
                const left = time - frames * dt;
                const error = Math.abs(spring.settlingTime() - left);
                assert(error <= 1e-6 * time, `${spring.settlingTime()}, not ${left}`);
            }
            spring.step(dt);
        }
        clamped += spring.clamp;
        assert(
            frames === Math.max(1, Math.ceil(time / dt)) || Math.abs(frames * dt - time) < 1e-6 * time + dt,
            `${frames * dt}: ${time}`,
        );
    }
    assert(clamped > 100);
    const undamped = new Spring(0, { duration: 1, bounce: 1 });
    undamped.target = 1;
    assert.strictEqual(undamped.settlingTime(), Infinity);
});

await test("a target at constant velocity is followed without lag, at any frame rate", () => {
    for (const rate of [15, 30, 60, 240]) {
        const spring = new Spring(3, { duration: 0.5, bounce: 0.3 });
        for (let i = 1; i <= 20 * rate; i++) {
            spring.target = 7 + (40 * i) / rate;
            spring.targetVelocity = 40;
            spring.step(1 / rate);
        }
        assert(
            Math.abs(spring.value - spring.target) < 1e-9,
            `${rate} per second: ${spring.value - spring.target}`,
        );
        assert(Math.abs(spring.velocity - 40) < 1e-9 && !spring.settled);
        assert.strictEqual(spring.settlingTime(), Infinity);
        spring.targetVelocity = 0;
        for (let i = 0; i < 3 * rate; i++) spring.step(1 / rate);
        assert(spring.settled && spring.value === spring.target);
    }
});

await test("new parameters keep value, velocity, target and tolerances", () => {
    const spring = new Spring(0, { duration: 0.5, restDelta: 0.01, restSpeed: 0.1 });
    spring.target = 1;
    spring.step(0.1);
    const { value, velocity, target } = spring;
    spring.set({ stiffness: 300, damping: 10 });
    assert.deepStrictEqual([spring.value, spring.velocity, spring.target], [value, velocity, target]);
    const same = new Spring(value, { stiffness: 300, damping: 10, restDelta: 0.01, restSpeed: 0.1 });
    same.velocity = velocity;
    same.target = 1;
    for (let i = 0; i < 100; i++) assert.strictEqual(spring.step(1 / 60), same.step(1 / 60));
    assert(spring.settled && same.settled);
    spring.set({ hertz: 3 });
    assert(spring.settled, "a value at rest on its target stays");
    refused(() => spring.set({ hertz: NaN }), "RangeError: hertz must be a finite number > 0, got NaN");
    refused(
        () => spring.set({ hertz: 1, bounce: 0 }),
        'TypeError: an option must be one of hertz, dampingRatio, restDelta, restSpeed, clamp, onRest, got "bounce"',
    );
    spring.set({ hertz: 2, clamp: true });
    assert.strictEqual(spring.clamp, true);
    spring.set({ onRest: null });
    assert.strictEqual(spring.clamp, true, "it stays");
    const free = new Spring(0, { stiffness: 0, damping: 4 });
    free.target = 5;
    for (let i = 0; i < 600; i++) free.step(1 / 60);
    assert(free.settled && free.value === 0);
    free.set({ duration: 0.2 });
    for (let i = 0; i < 600; i++) free.step(1 / 60);
    assert(free.settled && free.value === 5, "it has stiffness now");
});

await test("set() keeps what is not given, of the same form", () => {
    const onRest = () => {};
    for (const [before, changes, after] of [
        [{ stiffness: 300, damping: 5, mass: 2 }, {}, { stiffness: 300, damping: 5, mass: 2 }],
        [{ stiffness: 300, damping: 5 }, { restDelta: 0.1 }, { stiffness: 300, damping: 5, restDelta: 0.1 }],
        [{ stiffness: 300, damping: 5 }, { stiffness: 500 }, { stiffness: 500, damping: 5 }],
        [
            { duration: 0.3, bounce: 0.2, restSpeed: 1 },
            { bounce: 0.4 },
            { duration: 0.3, bounce: 0.4, restSpeed: 1 },
        ],
        [{ duration: 0.3, bounce: 0.2, restSpeed: 1 }, { hertz: 2 }, { hertz: 2, restSpeed: 1 }],
        [
            { hertz: 3, restDelta: 1 },
            { hertz: undefined, restDelta: undefined },
            { hertz: 3, restDelta: 1 },
        ],
        [{}, { bounce: 0.4, clamp: true, onRest }, { duration: 0.5, bounce: 0.4 }],
    ]) {
        const [one, other] = [new Spring(0, before), new Spring(0, after)];
        const [many, others] = [new Springs(2, before), new Springs(2, after)];
        one.set(changes);
        many.set(changes);
        assert.deepStrictEqual([one.clamp, one.onRest], [changes.clamp ?? false, changes.onRest ?? null]);
        assert.deepStrictEqual([many.clamp, many.onRest], [one.clamp, one.onRest]);
        one.clamp = many.clamp = false;
        one.target = other.target = 1;
        many.target.fill(1);
        others.target.fill(1);
        for (let i = 0; i < 60; i++) {
            assert.strictEqual(one.step(1 / 60), other.step(1 / 60), JSON.stringify(changes));
            assert.strictEqual(many.step(1 / 60), others.step(1 / 60));
            assert.deepStrictEqual(many.value, others.value);
        }
    }
    const stiffness = [100, 200];
    const lists = new Springs(2, { stiffness, damping: 5 });
    stiffness[0] = NaN; // it has a copy
    const wanted = new Springs(2, { stiffness: [100, 200], damping: [6, 7] });
    lists.set({ damping: [6, 7] });
    for (const set of [lists, wanted]) {
        set.target.fill(1);
        set.step(0.1);
    }
    assert.deepStrictEqual(lists.value, wanted.value);
});

await test("both tolerances decide when a spring settles", () => {
    const settling = (tolerances) => {
        const spring = new Spring(0, { duration: 0.5, bounce: 0.3, ...tolerances });
        spring.release(400, 65);
        return spring.settlingTime();
    };
    const usual = settling({});
    const soon = settling({ restDelta: 0.5, restSpeed: 10 });
    assert.deepStrictEqual([usual.toFixed(2), soon.toFixed(2)], ["0.94", "0.50"], "the times of README");
    assert.strictEqual(settling({ restDelta: 0.5 }), usual, "the speed is above its tolerance for longer");
});

await test("finished resolves when a spring rests, once, and at once if it does", async () => {
    const done = [];
    const spring = new Spring(0, { duration: 0.3 });
    const wait = (name) => spring.finished.then(() => done.push(name));
    const run = async (frames) => {
        for (let i = 0; i < frames; i++) spring.step(1 / 60);
        await null;
        await null;
    };
    await wait("nothing to do");
    spring.target = 1;
    wait("first");
    await run(5);
    spring.target = 2;
    wait("second");
    assert.strictEqual(spring.finished, spring.finished);
    await run(5);
    assert.deepStrictEqual(done, ["nothing to do"]);
    await run(100);
    assert.deepStrictEqual(done, ["nothing to do", "first", "second"]);
    spring.target = 2;
    wait("the same target");
    await run(1);
    spring.target = 3;
    wait("jump");
    spring.jump(7);
    await run(1);
    spring.targetVelocity = 1;
    wait("moving target");
    for (let i = 0; i < 300; i++) {
        spring.target += 1 / 60;
        spring.step(1 / 60);
    }
    assert.deepStrictEqual(done.slice(3), ["the same target", "jump"]);
    spring.targetVelocity = 0;
    await run(300);
    spring.target = 0;
    wait("finish");
    spring.finish();
    await run(1);
    assert.deepStrictEqual(done.slice(5), ["moving target", "finish"]);
    assert.deepStrictEqual([spring.value, spring.velocity, spring.settled], [0, 0, true]);
});

await test("gestures: the velocity of a pointer, and a release", () => {
    for (let i = 0; i < 100; i++) {
        const tracker = new VelocityTracker();
        const speed = uniform(-3000, 3000);
        const every = uniform(4, 20);
        for (let t = 0; t < 300; t += every) tracker.add(10 + (speed * t) / 1000, 5000 + t);
        assert(Math.abs(tracker.velocity() - speed) < 1e-6 * Math.abs(speed), "a constant velocity");
        const last = 5000 + Math.floor(300 / every - 1e-9) * every;
        assert(Math.abs(tracker.velocity(last + 100)) < 1e-9, "at rest for 100 ms");
        assert(Math.abs(tracker.velocity(last + 60)) < Math.abs(speed), "slower after 60 ms at rest");
    }
    const tracker = new VelocityTracker();
    assert.strictEqual(tracker.velocity(), 0);
    tracker.add(5, 100);
    assert.deepStrictEqual([tracker.velocity(), tracker.velocity(150)], [0, 0], "one sample");
    tracker.add(500, 100);
    assert.strictEqual(tracker.velocity(), 0, "two samples at one time");
    tracker.add(0, 1000);
    tracker.add(10, 1010);
    assert(Math.abs(tracker.velocity() - 1000) < 1e-9, "an earlier gesture has no effect");
    const spring = new Spring(0, { duration: 0.4 });
    spring.jump(30);
    spring.release(-500, 0);
    assert.deepStrictEqual(
        [spring.value, spring.velocity, spring.target, spring.settled],
        [30, -500, 0, false],
    );
    refused(() => spring.release(1, NaN), "RangeError: target must be a finite number, got NaN");
    assert.strictEqual(spring.velocity, -500);
});

await test("sets: parameters of each value, clamp, onRest, settled, finish", () => {
    const parameters = {
        hertz: [1, 2, 3, 4],
        dampingRatio: [0.2, 0.2, 1, 2],
        restDelta: 1e-3,
        restSpeed: 1e-2,
    };
    const rested = [];
    const many = new Springs(4, {
        ...parameters,
        clamp: true,
        onRest: (i, set) => rested.push([i, set.value[i]]),
    });
    const ones = [0, 1, 2, 3].map(
        (i) =>
            new Spring(0, {
                hertz: parameters.hertz[i],
                dampingRatio: parameters.dampingRatio[i],
                clamp: true,
            }),
    );
    many.target.set([1, 2, 3, 4]);
    ones.forEach((spring, i) => (spring.target = i + 1));
    let moving = 4;
    for (let i = 0; moving > 0; i++) {
        moving = many.step(1 / 60);
        ones.forEach((one, j) => {
            one.step(1 / 60);
            if (!many.settled(j) && !one.settled) assert.strictEqual(many.value[j], one.value);
            assert(many.value[j] <= j + 1, "never beyond the target");
        });
        assert(i < 300 && many.settled(0) === (many.value[0] === 1));
    }
    assert.deepStrictEqual([...many.value], [1, 2, 3, 4]);
    assert.deepStrictEqual(rested.map(([i]) => i).sort(), [0, 1, 2, 3]);
    many.velocity.fill(50);
    assert.strictEqual(many.step(1 / 60), 0, "a value on its target stays");
    many.target.fill(0);
    many.step(1 / 60);
    many.set({ duration: 0.2 });
    many.clamp = false;
    rested.length = 0;
    many.finish();
    assert.deepStrictEqual(
        [...many.value, ...many.velocity, many.step(0), rested.length],
        [0, 0, 0, 0, 0, 0, 0, 0, 0, 4],
    );
    many.targetVelocity[1] = 3;
    assert.strictEqual(many.step(0), 1, "it follows");
});

await test("console.log() shows the state of a spring", () => {
    const spring = new Spring(1);
    spring.target = 2;
    const text = inspect(spring);
    for (const part of ["value: 1", "velocity: 0", "target: 2", "targetVelocity: 0", "settled: false"])
        assert(text.includes(part), text);
    assert(inspect(new Springs(2)).includes("target: Float64Array(2) [ 0, 0 ]"));
});

/** Frames that a test requests; time in ms. */
function stage(now = true) {
    const it = { time: 0, callback: null, requests: 0 };
    const request = (frame) => {
        assert.strictEqual(it.callback, null, "one loop");
        it.callback = frame;
        it.requests++;
    };
    it.animate = animator(now ? { request, now: () => it.time } : { request });
    it.frame = (milliseconds) => {
        const { callback } = it;
        it.callback = null;
        callback?.((it.time += milliseconds));
        return callback !== null;
    };
    it.run = (most = 600) => {
        let frames = 0;
        while (it.frame(1000 / 60) && frames < most) frames++;
        return frames;
    };
    return it;
}

await test("animate: one loop that starts, stops, and has the values of its own steps", () => {
    const it = stage();
    const springs = Array.from({ length: 20 }, () => new Spring(0, { duration: 0.5, bounce: 0.2 }));
    const drawn = springs.map(() => []);
    const stops = springs.map((spring, i) => it.animate(spring, (value) => drawn[i].push(value)));
    assert(it.frame(16) && it.callback === null, "one frame, because nothing moves");
    for (const list of drawn) assert.deepStrictEqual(list.splice(0), [0], "the first value is drawn");
    for (let round = 1; round < 30; round++) {
        for (const spring of springs) spring.target = round % 2;
        const reference = new Spring(1 - (round % 2), { duration: 0.5, bounce: 0.2 });
        reference.target = round % 2;
        for (const list of drawn) list.length = 0;
        let since = it.time; // of the reference
        const expected = [];
        for (let i = 0; it.callback; i++) {
            // The first frame may be earlier than the event. Later, a tab may be hidden.
            it.frame(i === 0 ? uniform(-16, 16) : bits() % 20 ? 1000 / 60 : uniform(100, 20000));
            expected.push(reference.step(Math.max(0, it.time - since) / 1000));
            since = Math.max(since, it.time);
            assert(i < 200);
        }
        for (const list of drawn) {
            assert.deepStrictEqual(list, expected);
            assert.strictEqual(list.at(-1), round % 2, "it settles on its target");
        }
    }
    for (const stop of stops) stop();
    springs[0].target = 9;
    assert.strictEqual(it.callback, null, "stopped");
});

await test("animate: each change starts the loop, rest stops it", () => {
    const it = stage(false);
    let draws = 0;
    const spring = new Spring(0, { duration: 0.3 });
    it.animate(spring, () => draws++);
    it.run();
    assert.strictEqual(draws, 1);
    const changes = {
        target: () => (spring.target = 1),
        "the same target": () => (spring.target = 1),
        value: () => (spring.value = 0.5),
        velocity: () => (spring.velocity = 3),
        release: () => spring.release(-3, 2),
        jump: () => spring.jump(7),
        "parameters that move nothing": () => spring.set({ stiffness: 0, damping: 5 }),
        "a target without stiffness": () => (spring.target = 9),
        "parameters that move": () => spring.set({ duration: 0.2 }),
    };
    for (const [name, change] of Object.entries(changes)) {
        draws = 0;
        change();
        const still = name.includes("nothing");
        assert.strictEqual(it.run() > 0 || draws > 0, !still, name);
        assert(spring.settled && it.callback === null, `${name}: rest`);
    }
    const many = new Springs(3, { duration: 0.3 });
    it.animate(many, () => draws++);
    it.run();
    for (const change of [
        () => (many.target[1] = 5),
        () => many.velocity.fill(2),
        () => (many.value[0] = 1),
        () => (many.targetVelocity[2] = 1),
    ]) {
        change();
        assert(it.callback, "it runs");
        if (many.targetVelocity[2] === 0) assert(it.run() < 300 && many.step(0) === 0);
        else assert.strictEqual(it.run(200), 200, "as long as a target moves");
    }
});

await test("animate: changes and errors in callbacks", () => {
    const it = stage();
    const thrown = [];
    globalThis.reportError = (error) => thrown.push(error.message);
    const [lead, follower] = [new Spring(0, { duration: 0.3 }), new Spring(0, { duration: 0.3 })];
    const seen = [];
    it.animate(lead, (value) => (follower.target = value));
    const stop = it.animate(follower, (value, spring) => seen.push(value === spring.value));
    it.animate(follower, () => {
        throw new Error("a callback");
    });
    lead.target = 1;
    const frames = it.run();
    assert(follower.settled && follower.value === 1 && frames < 120 && seen.every(Boolean));
    assert.strictEqual(thrown.length, seen.length);
    stop();
    stop();
    seen.length = 0;
    lead.onRest = (spring) => spring.value < 5 && spring.target++;
    lead.target = 2;
    it.run();
    assert(lead.value === 5 && follower.value === 5 && seen.length === 0, "a new target when one is reached");
    const wild = new Spring(0, { stiffness: 0, damping: 0 });
    it.animate(wild, () => {});
    wild.velocity = 1e308;
    thrown.length = 0;
    lead.onRest = null;
    lead.target = 0;
    it.frame(1e6);
    it.frame(1e6);
    assert.deepStrictEqual([thrown[0], lead.value], ["value or velocity overflows", 0]);
    delete globalThis.reportError;
    refused(() => animator({ request: null })(lead, () => {}), "TypeError: request must be...");
    refused(() => animate(lead, null), "TypeError: draw must be a function, got null");
    refused(() => animate(lead, () => {}), "TypeError: the spring is animated by another loop");
    refused(
        () => it.animate(new Spring(0), () => {}, { reducedMotion: "off" }),
        'TypeError: reducedMotion must be "jump" or "run", got "off"',
    );
    refused(
        () => it.animate(new Spring(0), () => {}, { reducedMotions: "run" }),
        'TypeError: an option must be reducedMotion, got "reducedMotions"',
    );
    for (const options of [null, 3])
        refused(
            () => it.animate(new Spring(0), () => {}, options),
            `TypeError: options must be an object, got ${options}`,
        );
    for (const none of [undefined, null, 3, [lead, follower]])
        refused(() => it.animate(none, () => {}), "TypeError: spring must be a Spring or Springs, got...");
});

/** Springs and ways to set their targets: alike for animate(). */
const kinds = {
    Spring: (options) => {
        const one = new Spring(0, options);
        return [one, (target) => (one.target = target), () => one.value];
    },
    Springs: (options) => {
        const many = new Springs(1, options);
        return [many, (target) => (many.target[0] = target), () => many.value[0]];
    },
};

await test("animate: a frame in which onRest throws is drawn, and each value is told", () => {
    const thrown = [];
    globalThis.reportError = (error) => thrown.push(error.message);
    for (const reduced of [false, true]) {
        globalThis.matchMedia = () => ({ matches: reduced });
        for (const [kind, make] of Object.entries(kinds)) {
            const it = stage();
            const [spring, aim] = make({ duration: 0.3 });
            spring.onRest = () => {
                throw new Error("rested");
            };
            let drawn;
            it.animate(spring, (value) => (drawn = kind === "Spring" ? value : value[0]));
            aim(7);
            it.run();
            assert.deepStrictEqual([drawn, thrown.splice(0)], [7, ["rested"]], `${kind} ${reduced}`);
            assert.strictEqual(it.callback, null);
        }
    }
    delete globalThis.matchMedia;
    delete globalThis.reportError;
    const told = [];
    const many = new Springs(3, { duration: 0.3, onRest: (i) => refuse(told.push(i)) });
    const refuse = (count) => {
        throw new Error(`value ${count}`);
    };
    many.target.fill(1);
    assert.throws(() => many.step(100), /value 1/);
    many.target.fill(2);
    assert.throws(() => many.finish(), /value 4/);
    assert.deepStrictEqual(told, [0, 1, 2, 0, 1, 2]);
});

await test("animate: a value that draw finishes is drawn, also if onRest throws", () => {
    globalThis.reportError = () => {};
    const it = stage();
    const spring = new Spring(0, { duration: 0.3 });
    spring.onRest = () => {
        throw new Error("rested");
    };
    let drawn;
    it.animate(spring, (value) => {
        drawn = value;
        if (value > 50) spring.finish();
    });
    spring.target = 100;
    it.run();
    assert.strictEqual(drawn, 100);
    delete globalThis.reportError;
});

await test("animate: a spring that a callback of another one stops stays where it is", () => {
    for (const make of Object.values(kinds))
        for (const when of ["draw", "onRest"]) {
            const it = stage();
            const lead = new Spring(0, { duration: 0.3 });
            const [other, aim, valueOf] = make({ duration: 0.3 });
            let draws = 0;
            let before;
            const end = () => {
                before = valueOf();
                stop();
            };
            if (when === "onRest") lead.onRest = end;
            it.animate(lead, (value) => when === "draw" && value > 0.5 && before === undefined && end());
            const stop = it.animate(other, () => (draws += before !== undefined));
            other.onRest = () => draws++;
            lead.target = 1;
            aim(1);
            it.run();
            assert.deepStrictEqual([valueOf(), draws], [before, 0], when);
            assert(before > 0 && before < 1 && lead.settled);
        }
});

await test("animate: draw functions that read other Springs do not run for ever, and those that write move them", () => {
    const thrown = [];
    globalThis.reportError = (error) => thrown.push(error.message);
    for (const reduced of [false, true]) {
        globalThis.matchMedia = () => ({ matches: reduced });
        const it = stage();
        const [xs, ys, last, placed] = Array.from({ length: 4 }, () => new Springs(2, { duration: 0.3 }));
        const draws = [0, 0, 0, 0];
        let shown;
        [xs, ys, last, placed].forEach((springs, i) =>
            it.animate(springs, () => {
                draws[i]++;
                shown = [...xs.value, ...ys.value, ...last.value, ...placed.value];
            }),
        );
        it.run();
        assert.deepStrictEqual(draws, [1, 1, 1, 1]);
        xs.target.fill(100);
        assert(it.run() < 100 && xs.settled(0));
        assert.deepStrictEqual(draws.slice(1), [1, 1, 1], "a read draws nothing");
        it.animate(xs, ([x]) => (ys.target[1] = x));
        it.animate(ys, ([, y]) => (last.target[0] = y));
        it.animate(last, ([z]) => (placed.value[0] = placed.target[0] = z));
        xs.target[0] = 50;
        assert(it.run() < 300);
        assert.deepStrictEqual(shown, [50, 100, 0, 50, 50, 0, 50, 0], "each follows the one before it");
        it.animate(last, () => (placed.target[1] = NaN));
        xs.target[0] = 20;
        assert(it.run() < 300);
        assert.deepStrictEqual(thrown.splice(0), ["target[1] must be a finite number, got NaN"]);
    }
    delete globalThis.matchMedia;
    delete globalThis.reportError;
});

await test("animate: a target near the value that a callback sets is reached", () => {
    for (const [kind, make] of Object.entries(kinds))
        for (const when of ["draw", "onRest"]) {
            const it = stage();
            const [spring, aim, valueOf] = make({ restDelta: 0.5, restSpeed: 10 });
            let rests = 0;
            const again = () => valueOf() === 100 && aim(100.4);
            spring.onRest = () => ++rests && when === "onRest" && again();
            it.animate(spring, () => when === "draw" && again());
            aim(100);
            assert(it.run() < 200);
            assert.deepStrictEqual([valueOf(), rests], [100.4, 2], `${kind} ${when}`);
        }
});

await test("animate: one value of Springs that cannot move does not stop the others", () => {
    const thrown = [];
    globalThis.reportError = (error) => thrown.push(error.message);
    const bad = { target: NaN, velocity: Infinity, targetVelocity: -Infinity };
    for (const reduced of [false, true])
        for (const [name, number] of Object.entries(bad)) {
            if (reduced && name === "velocity") continue; // finish() does not need it
            globalThis.matchMedia = () => ({ matches: reduced });
            const [it, alone] = [stage(), stage()];
            const [many, others] = [new Springs(3, { duration: 0.3 }), new Springs(3, { duration: 0.3 })];
            const [drawn, wanted] = [[], []];
            it.animate(many, ([a, , c], { target }) => drawn.push([a, c, target[0]]));
            alone.animate(others, ([a, , c], { target }) => wanted.push([a, c, target[0]]));
            many.target.set([1, 5, 2]);
            others.target.set([1, 0, 2]);
            many[name][1] = number;
            assert.strictEqual(it.run(), alone.run());
            assert.deepStrictEqual(drawn, wanted, `${name} ${reduced}`);
            assert.deepStrictEqual(drawn.at(-1), [1, 2, 1]);
            const message = `${name}[1] must be a finite number, got ${number}`;
            assert.deepStrictEqual(thrown.splice(0), [message]);
            assert.deepStrictEqual([many.value[1], many[name][1]], [0, number], "it keeps its state");
            if (name !== "velocity") refused(() => many.finish(), `RangeError: ${message}`);
            assert.strictEqual(many.value[1], 0);
            many[name][1] = 0;
            it.run();
            assert.strictEqual(many.value[1], many.target[1], "it moves on");
        }
    delete globalThis.matchMedia;
    delete globalThis.reportError;
});

await test("animate: reduced motion jumps, or as told", async () => {
    const it = stage();
    globalThis.matchMedia = () => ({ matches: true });
    let rested = 0;
    const spring = new Spring(0, { duration: 0.3, onRest: () => rested++ });
    const fade = new Spring(0, { duration: 0.3 });
    const many = new Springs(2);
    const drawn = [];
    it.animate(spring, (value) => drawn.push(value));
    it.animate(fade, () => {}, { reducedMotion: "run" });
    it.animate(many, () => {});
    spring.target = fade.target = many.target[1] = 4;
    const finished = spring.finished;
    it.frame(16);
    await finished;
    assert.deepStrictEqual([drawn, rested, many.value[1]], [[4], 1, 4]);
    assert(!fade.settled && it.run() > 10 && fade.value === 4);
    it.animate(fade, () => {})();
    it.animate(fade, () => {});
    fade.target = 5;
    assert(it.frame(16) && !fade.settled, "another function that draws does not end the first one's choice");
    delete globalThis.matchMedia;
});

await test("animate: without requestAnimationFrame it uses a timer", async () => {
    const spring = new Spring(0, { duration: 0.05 });
    const drawn = [];
    const stop = animate(spring, (value) => drawn.push(value));
    spring.target = 1;
    await spring.finished;
    assert(drawn.at(-1) === 1 && spring.value === 1);
    stop();
});

await test("linear() of CSS: within 0.2 % of the way in the range of its declaration", () => {
    for (let i = 0; i < 402; i++) {
        const hard = [-11.995807, -11.915117][i - 400]; // with a large error within a cell
        const options = hard
            ? { hertz: 1, dampingRatio: 0.1 }
            : i < 20
              ? { duration: 0.5, bounce: -0.95 + 0.08 * i }
              : { hertz: logarithmic(0.1, 20), dampingRatio: logarithmic(0.1, 5) };
        const ratio =
            options.dampingRatio ?? (options.bounce < 0 ? 1 / (1 + options.bounce) : 1 - options.bounce);
        const velocity = hard ?? (i % 2 || ratio > 2 ? 0 : uniform(-12, 12) * (options.hertz ?? 2));
        const { duration, easing } = linear(options, velocity);
        const points = /^linear\((.*)\)$/
            .exec(easing)[1]
            .split(", ")
            .map((point) => point.split(" "));
        const times = points.map(([, at], j) => (at ? parseFloat(at) / 100 : j ? 1 : 0));
        if (ratio >= 0.25 && velocity === 0) assert(points.length <= 40, `${points.length} points`);
        const spring = new Spring(0, { ...options, restDelta: 0, restSpeed: 0 });
        spring.target = 1;
        if (velocity) spring.velocity = velocity;
        let most = Math.abs(points.at(-1)[0] - 1);
        const samples = hard ? 50000 : 3000;
        for (let k = 1, j = 1; k <= samples; k++) {
            const value = spring.step(duration / (1000 * samples));
            while (times[j] < k / samples) j++;
            const [from, to] = [points[j - 1][0], points[j][0]].map(Number);
            const at = from + ((to - from) * (k / samples - times[j - 1])) / (times[j] - times[j - 1]);
            most = Math.max(most, Math.abs(at - value));
        }
        assert(most <= 0.002, `${JSON.stringify(options)} ${velocity}: ${most}`);
    }
    for (const option of ["clamp", "onRest", "restDelta", "restSpeed"])
        refused(
            () => linear({ hertz: 1, [option]: option === "onRest" ? null : 0 }),
            `TypeError: an option must be one of hertz, dampingRatio, got "${option}"`,
        );
    const [short, long] = [linear({ duration: 1e-6 }).duration, linear({ duration: 1 }).duration];
    assert(Math.abs(short / long - 1e-6) < 1e-11, `${short} and ${long} ms`);
    refused(() => linear({ duration: 1, bounce: 1 }), "RangeError: the spring does not settle");
    for (const [options, velocity] of [
        [{ duration: 0.5, bounce: 0.999 }],
        [{ hertz: 1, dampingRatio: 0.1 }, 1e4],
        [{ hertz: 1, dampingRatio: 10 }, -200],
        [{ hertz: 1, dampingRatio: 692 }, -847],
    ])
        refused(() => linear(options, velocity), "RangeError: the motion is too fast for an easing...");
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

await test("sets: the size of a motion is that of Spring after any writes between steps", () => {
    const options = { duration: 0.4 }; // critically damped: a value within its tolerances stays within them
    let rests = 0;
    for (let i = 0; i < 200; i++) {
        const one = new Spring(0, options);
        const many = new Springs(1, options);
        for (let n = 0; n < 400; n++) {
            if (bits() % (n % 100 < 40 ? 10 : 200) === 0) {
                if (bits() % 2) for (const spring of [one, many]) spring.finish();
                const name = ["target", "value", "velocity"][bits() % 3];
                const number =
                    bits() % 2 ? [0, 1, -90, 1e6][bits() % 4] : uniform(-1, 1) * logarithmic(1e-4, 1e4);
                one[name] = many[name][0] = number;
            }
            const moving = many.step(1 / 60);
            one.step(1 / 60);
            rests += !moving;
            assert.deepStrictEqual([many.value[0], moving], [one.value, +!one.settled], `frame ${n}`);
        }
    }
    assert(rests > 10000, `${rests} frames at rest`);
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
        const each = [];
        const many = new Springs(2, { stiffness: 0, damping, onRest: (i) => each.push(i) });
        many.value.fill(7);
        many.velocity[1] = velocity;
        let moving = 1;
        for (let t = 0; t < 60 && moving > 0; t += 1 / 60) moving = many.step(1 / 60);
        assert(moving === 0 && many.settled(1) && many.value[0] === 7);
        assert(
            Math.abs(many.value[1] - 7 - way) <= 1.001e-4 * Math.abs(way),
            `${many.value[1] - 7}, not ${way}`,
        );
        assert.deepStrictEqual(each, [1]);
        // finish() has the same end.
        s.velocity = many.velocity[1] = velocity;
        const ends = [s.value + way, many.value[1] + way];
        s.finish();
        many.finish();
        assert(s.settled && many.settled(1) && many.value[0] === 7);
        assert(Math.abs(s.value - ends[0]) + Math.abs(many.value[1] - ends[1]) <= 1e-12 * Math.abs(ends[0]));
    }
    const undamped = new Spring(7, { stiffness: 0, damping: 0 });
    undamped.velocity = 1;
    undamped.finish();
    assert(undamped.settled && undamped.value === 7);
    // Other parameters: it stays at rest without stiffness, and with it moves as another spring from there.
    let again = 0;
    undamped.onRest = () => again++;
    undamped.set({ stiffness: 0, damping: 3 });
    assert(undamped.settled && undamped.step(0.1) === 7 && again === 0);
    const stiff = { stiffness: 100, damping: 20 };
    const [late, fresh] = [new Springs(1, { stiffness: 0, damping: 5 }), new Springs(1, stiff)];
    late.target[0] = fresh.target[0] = 10;
    assert(late.step(0.1) === 0);
    late.set(stiff);
    let frames = 0;
    while (fresh.step(1 / 60) > 0) frames += late.step(1 / 60);
    assert(frames > 10 && late.step(1 / 60) === 0 && late.settled(0));
    const far = new Springs(1, { stiffness: 0, damping: 5 });
    far.value[0] = 1e308;
    far.target[0] = -1e308;
    assert(far.settled(0) && far.step(0.1) === 0, "also where their difference overflows");
    const wrong = new Springs(1, { stiffness: 0, damping: 5 });
    wrong.target[0] = NaN;
    assert(!wrong.settled(0));
    assert.throws(() => wrong.finish(), /target\[0\]/);
    wrong.target[0] = 0;
    wrong.value[0] = NaN;
    assert.throws(() => wrong.finish(), /value\[0\]/);
});

await test("a loop of another copy of the package finds a change", async () => {
    const it = stage();
    const other = await import("../watch.js?another");
    let calls = 0;
    const spring = new Spring(0);
    other.watch(spring, () => calls++);
    spring.target = 1;
    assert(calls > 0 && new Springs(1)[other.moves]() === false);
    assert.throws(() => it.animate(spring, () => {}), /another loop/);
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

await test("onRest may normalise the value and the target, and is called again only if that changes them", () => {
    const ways = {
        value: (spring) => (spring.value %= 360),
        jump: (spring) => spring.jump(spring.value % 360),
        finish(spring) {
            if (spring.value >= 360) spring.target -= 360;
            spring.finish();
        },
    };
    for (const [name, normalise] of Object.entries(ways)) {
        let rests = 0;
        const angle = new Spring(0, { duration: 0.3 });
        angle.onRest = () => {
            rests++;
            normalise(angle);
            angle.target = angle.value;
        };
        angle.target = 800;
        for (let i = 0; i < 100; i++) angle.step(1 / 60);
        assert.deepStrictEqual([angle.value, angle.target, angle.settled], [80, 80, true], name);
        assert(rests <= 3, `${name}: ${rests} times`);
    }
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
    refused(spring({ hertz: 1e200 }), "RangeError: hertz must be in range, got 1e+200");
    refused(spring({ hertz: 1e-160 }), "RangeError: hertz must be in range, got 1e-160");
    refused(
        spring({ halfLife: 1, dampingRatio: 0 }),
        "RangeError: dampingRatio must be a finite number > 0, got 0",
    );
    const more = "restDelta, restSpeed, clamp, onRest";
    for (const [options, possible, name] of [
        [{ damping: 3 }, "duration, bounce", "damping"],
        [{ bouncy: 1 }, "duration, bounce", "bouncy"],
        [{ duration: 1, bouncy: 1 }, "duration, bounce", "bouncy"],
        [{ hertz: 1, bounce: 0 }, "hertz, dampingRatio", "bounce"],
        [{ hertz: 1, duration: 1 }, "duration, bounce", "hertz"],
        [{ ...good, tolerance: 1 }, "stiffness, damping, mass", "tolerance"],
    ])
        refused(spring(options), `TypeError: an option must be one of ${possible}, ${more}, got "${name}"`);
    refused(spring(null), "TypeError: options must be an object, got null");
    refused(spring(3), "TypeError: options must be an object, got 3");
    refused(() => new Springs(2, null), "TypeError: options must be an object, got null");
    refused(() => new Spring(0).set(), "TypeError: options must be an object, got undefined");
    refused(spring({ ...good, restDelta: -1 }), "RangeError: restDelta must be a finite number >= 0, got -1");
    refused(
        spring({ ...good, restSpeed: NaN }),
        "RangeError: restSpeed must be a finite number >= 0, got NaN",
    );
    refused(spring({ ...good, onRest: 3 }), "TypeError: onRest must be a function or null, got 3");
    for (const Kind of [Spring, Springs]) {
        const one = new Kind(1);
        for (const [wrong, wanted] of [
            [{ clamp: [true] }, "TypeError: clamp must be a boolean, got [true]"],
            [{ clamp: 1 }, "TypeError: clamp must be a boolean, got 1"],
            [{ onRest: [() => {}] }, "TypeError: onRest must be a function or null, got [() => {}]"],
        ]) {
            refused(() => new Kind(1, wrong), wanted);
            refused(() => one.set(wrong), wanted);
        }
        refused(() => (one.onRest = 5), "TypeError: onRest must be a function or null, got 5");
        refused(() => (one.clamp = "false"), 'TypeError: clamp must be a boolean, got "false"');
        refused(() => (one.clamp = undefined), "TypeError: clamp must be a boolean, got null");
        assert.deepStrictEqual([one.clamp, one.onRest], [false, null]);
    }
    for (const [value, shown] of [
        [[2], "[2]"],
        [Float64Array.of(2, 3), "[2,3]"],
        [2n, "2n"],
        ["2", '"2"'],
    ])
        refused(() => new Spring(value), `TypeError: value must be a finite number, got ${shown}`);
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
        () => new Springs(2, { ...good, damping: [1, 2, 3] }),
        "RangeError: damping.length must be 2, got 3",
    );
    refused(
        () => new Springs(2, { ...good, damping: [1, -2] }),
        "RangeError: value 1: damping must be a finite number >= 0, got -2",
    );
    for (const [wrong, wanted] of [
        [{ hertz: [10, undefined] }, "hertz[1] must be a number, got undefined"],
        [{ hertz: Object.assign(Array(2), { 1: 3 }) }, "hertz[0] must be a number, got undefined"],
        [{ restSpeed: [1, null] }, "restSpeed[1] must be a number, got null"],
        [{ restDelta: null }, "restDelta must be a finite number >= 0, got null"],
    ])
        refused(() => new Springs(2, wrong), `TypeError: ${wanted}`);
    refused(spring({ restSpeed: null }), "TypeError: restSpeed must be a finite number >= 0, got null");
    refused(() => new Springs(2).settled(2), "RangeError: i must be the index of one of 2 values, got 2");
    const many = new Springs(3, good);
    many.target.set([1, NaN, 1]);
    refused(() => many.step(0.1), "RangeError: target[1] must be a finite number, got NaN");
    assert(many.value[0] > 0 && many.value[1] === 0 && many.value[2] > 0, "the others have moved");
    many.target.set([1, -1e308, 1]);
    many.value[1] = 1.5e308;
    refused(() => many.step(0.1), "RangeError: value[1] or velocity[1] overflows");
});

done();
