// SPDX-License-Identifier: MIT
// Random springs, single and in sets, against the C library: every bit of value and velocity after each step.
import assert from "node:assert";
import { spawnSync } from "node:child_process";
import { Spring, Springs } from "../index.js";
import { settings } from "../options.js";
import { bits, chance, extreme, logarithmic, uniform, usual } from "./random.mjs";

const steps = 4;
const perSet = 64;
const atOnce = 50000; // records of one process

/** Runs the C program on records of doubles. */
function inC(program, mode, records) {
    const input = Buffer.from(records.buffer, records.byteOffset, records.byteLength);
    const run = spawnSync(program, [mode], { input, maxBuffer: 1 << 30 });
    assert.strictEqual(run.status, 0, `${program} ${mode}: ${run.error ?? run.stderr}`);
    const bytes = new Uint8Array(run.stdout);
    return new Float64Array(bytes.buffer, 0, bytes.length / 8);
}

function timeStep(omega, zeta) {
    const scale = isFinite(1 / omega) && omega > 0 ? 1 / omega / Math.max(1, zeta || 1) : 1;
    const dt = chance(0.5) ? 1 / uniform(30, 240) : logarithmic(1e-3, 1e3) * scale;
    return chance(0.05) ? -Math.min(dt, 1e300) : Math.min(dt, 1e300);
}

/** mass, stiffness, damping, value, velocity, two targets, four time steps */
function singleRecord(record) {
    const p = chance(0.75) ? usual() : extreme();
    const near = chance(0.3) ? 1e-12 : 1000;
    const target = chance(0.1) ? 0 : uniform(-1000, 1000);
    const speed = isFinite(p.omega) ? uniform(-1, 1) * near * p.omega + 0 : 1; // no -0
    record.set([p.mass, p.stiffness, p.damping, target + uniform(-1, 1) * near, speed, target]);
    record[6] = chance(0.5) ? target : uniform(-1000, 1000);
    for (let i = 0; i < steps; i++) record[7 + i] = timeStep(p.omega, p.zeta);
}

/** [failed, value, velocity] after each step, as js_states writes them, but 1 for each failure. */
function stepSingle([mass, stiffness, damping, value, velocity, first, second, ...dt], out) {
    let s;
    try {
        s = new Spring(value, { stiffness, damping, mass, restDelta: 0, restSpeed: 0 });
        s.velocity = velocity;
    } catch (error) {
        if (!(error instanceof RangeError)) throw error;
    }
    for (let i = 0; i < steps; i++) {
        let failed = s === undefined;
        try {
            if (s) {
                s.target = i < steps / 2 ? first : second;
                s.step(dt[i]);
            }
        } catch (error) {
            if (!(error instanceof RangeError)) throw error;
            failed = true;
        }
        out.set([failed ? 1 : 0, s?.value ?? value, s?.velocity ?? velocity], 3 * i);
    }
}

/** How many of `count` random springs differ; and how many were stepped. */
export function compareSingle(program, count) {
    let different = 0;
    let stepped = 0;
    let rested = 0;
    const size = 7 + steps;
    for (let from = 0; from < count; from += atOnce) {
        const n = Math.min(atOnce, count - from);
        const records = new Float64Array(size * n);
        for (let i = 0; i < n; i++) singleRecord(records.subarray(size * i, size * (i + 1)));
        const want = inC(program, "single", records);
        assert.strictEqual(want.length, 3 * steps * n);
        const got = new Float64Array(3 * steps);
        for (let i = 0; i < n; i++) {
            stepSingle(records.subarray(size * i, size * (i + 1)), got);
            const expected = want.slice(3 * steps * i, 3 * steps * (i + 1));
            for (let j = 0; j < steps; j++) {
                stepped += expected[3 * j] === 0;
                rested += expected[3 * j] === 0 && expected[3 * j + 2] === 0;
                expected[3 * j] = expected[3 * j] === 0 ? 0 : 1;
            }
            if (Buffer.compare(Buffer.from(got.buffer), Buffer.from(expected.buffer)) !== 0) {
                if (different++ < 3)
                    console.log(
                        `# ${records.subarray(size * i, size * (i + 1))}\n#   ${got}\n#   ${expected}`,
                    );
            }
        }
    }
    return { different, stepped, rested };
}

/** Of `count` springs of a settling time, how many have other parameters than those of spring_params_settling(). */
export function compareSettling(program, count) {
    const records = new Float64Array(3 * count);
    for (let i = 0; i < count; i++)
        records.set(
            [logarithmic(0.01, 100), logarithmic(0.01, 20), chance(0.5) ? 1e-3 : logarithmic(1e-6, 0.9)],
            3 * i,
        );
    const want = inC(program, "settling", records);
    let different = 0;
    for (let i = 0; i < count; i++) {
        const [settling, dampingRatio, tolerance] = records.subarray(3 * i);
        const { p } = settings({ settling, dampingRatio, tolerance });
        different += p.omega2 !== want[2 * i] || 2 * p.b !== want[2 * i + 1];
    }
    return different;
}

const steered = 30;

/** 64 records of springs that are steered, with the same time steps: struct steer of js_states.c. */
function steerRecords(records) {
    const size = 8 + 3 * steered;
    const dt = Array.from({ length: steered }, () =>
        Math.abs(timeStep(2 * Math.PI * logarithmic(0.1, 10), 1)),
    );
    for (let i = 0; i < perSet; i++) {
        const record = records.subarray(size * i, size * (i + 1));
        const [p, q] = [usual(), usual()];
        if (chance(0.05)) p.stiffness = 0;
        if (chance(0.05)) q.damping = 0;
        record.set([p.mass, q.mass, p.stiffness, q.stiffness, p.damping, q.damping]);
        let target = uniform(-1000, 1000);
        let speed = 0;
        record[6] = target + uniform(-1, 1) * (chance(0.3) ? 1e-12 : 100);
        record[7] = chance(0.3) ? 0 : uniform(-1, 1) * p.omega;
        for (let j = 0; j < steered; j++) {
            if (chance(0.1)) speed = chance(0.5) ? 0 : uniform(-100, 100);
            if (chance(0.1)) target = uniform(-1000, 1000);
            target += speed * dt[j];
            record[8 + j] = target;
            record[8 + steered + j] = speed;
            record[8 + 2 * steered + j] = dt[j];
        }
    }
}

const stepped = (object, dt) => {
    try {
        object.step(dt);
    } catch (error) {
        if (!(error instanceof RangeError)) throw error;
    }
};

/** Of `count` springs whose targets move and whose parameters change: how many steps of Spring and of Springs differ. */
export function compareSteered(program, count) {
    const size = 8 + 3 * steered;
    const result = { one: 0, many: 0, landed: 0, steps: 0 };
    const tolerances = { restDelta: 0, restSpeed: 0 };
    for (let from = 0; from < count; from += perSet) {
        const records = new Float64Array(size * perSet);
        steerRecords(records);
        const want = inC(program, "steer", records);
        const of = (i, k) => records[size * i + k];
        const column = (k) => Float64Array.from({ length: perSet }, (_, i) => of(i, k));
        const parameters = (half) => ({
            mass: column(half),
            stiffness: column(2 + half),
            damping: column(4 + half),
        });
        const one = (all, i) =>
            Object.fromEntries(Object.entries(all).map(([name, list]) => [name, list[i]]));
        const springs = Array.from(
            { length: perSet },
            (_, i) => new Spring(of(i, 6), { ...one(parameters(0), i), ...tolerances }),
        );
        springs.forEach((spring, i) => (spring.velocity = of(i, 7)));
        const many = new Springs(perSet, { ...parameters(0), ...tolerances });
        many.value.set(column(6));
        many.velocity.set(column(7));
        for (let j = 0; j < steered; j++) {
            if (j === steered / 2) {
                springs.forEach((spring, i) => spring.set(one(parameters(1), i)));
                many.set(parameters(1));
            }
            many.target.set(column(8 + j));
            many.targetVelocity.set(column(8 + steered + j));
            stepped(many, of(0, 8 + 2 * steered + j));
            springs.forEach((spring, i) => {
                spring.target = of(i, 8 + j);
                spring.targetVelocity = of(i, 8 + steered + j);
                stepped(spring, of(i, 8 + 2 * steered + j));
                const [, x, v] = want.subarray(3 * (steered * i + j));
                result.steps++;
                result.landed += x === spring.target && v === spring.targetVelocity;
                result.one += !Object.is(spring.value, x) || !Object.is(spring.velocity + 0, v);
                result.many += !Object.is(many.value[i], x) || !Object.is(many.velocity[i] + 0, v);
            });
        }
    }
    return result;
}

/** mass, stiffness, damping, dt, two tolerances, values, velocities, targets, their velocities */
function setRecord(record) {
    const p = usual();
    const near = chance(0.3) ? logarithmic(1e-13, 1e-6) : chance(0.3) ? 0.01 : 1000;
    const moves = chance(0.3);
    if (chance(0.05)) p.stiffness = 0;
    const tolerance = p.stiffness === 0 || chance(0.5) ? 0 : 0.001;
    if (chance(0.05)) p.damping = 0;
    else if (chance(0.05)) p.damping *= logarithmic(1e-20, 1e-13); // decays slowly
    record.set([
        p.mass,
        p.stiffness,
        p.damping,
        chance(0.05) ? 0 : timeStep(p.omega, p.zeta),
        tolerance,
        10 * tolerance,
    ]);
    for (let i = 0; i < perSet; i++) {
        const target = chance(0.1) ? 0 : uniform(-1000, 1000);
        record[6 + i] = target + uniform(-1, 1) * near;
        record[6 + perSet + i] = uniform(-1, 1) * near * p.omega;
        record[6 + 3 * perSet + i] = moves && chance(0.5) ? uniform(-100, 100) : 0;
        record[6 + 2 * perSet + i] = bits() % 200 === 0 ? [NaN, Infinity, 1.5e308][bits() % 3] : target;
    }
}

/** How many of `count` springs, in sets of 64, differ; and of how many sets the number that still move. */
export function compareSets(program, count) {
    let different = 0;
    let miscounted = 0;
    const size = 6 + 4 * perSet;
    const sets = Math.ceil(count / perSet);
    const records = new Float64Array(size * sets);
    for (let i = 0; i < sets; i++) setRecord(records.subarray(size * i, size * (i + 1)));
    const want = inC(program, "set", records);
    for (let i = 0; i < sets; i++) {
        const r = records.subarray(size * i, size * (i + 1));
        const expected = want.subarray((2 * perSet + 2) * i, (2 * perSet + 2) * (i + 1));
        const [mass, stiffness, damping, dt, restDelta, restSpeed] = r;
        const s = new Springs(perSet, { stiffness, damping, mass, restDelta, restSpeed });
        s.value.set(r.subarray(6, 6 + perSet));
        s.velocity.set(r.subarray(6 + perSet, 6 + 2 * perSet));
        s.target.set(r.subarray(6 + 2 * perSet, 6 + 3 * perSet));
        s.targetVelocity.set(r.subarray(6 + 3 * perSet));
        const [wantMoving, status] = expected.subarray(2 * perSet);
        let moving = -1;
        try {
            moving = s.step(dt);
        } catch (error) {
            if (!(error instanceof RangeError)) throw error;
        }
        // Without stiffness, a value rests where it is, with the velocity 0; in C, only on its target, and maybe with -0.
        const zero = stiffness > 0 ? -0 : 0;
        const counts = stiffness > 0 || moving < 0 || status !== 0;
        miscounted += counts && moving !== (status === 0 ? wantMoving : -1);
        for (let j = 0; j < perSet; j++)
            different +=
                !Object.is(s.value[j], expected[j]) || !Object.is(s.velocity[j], expected[perSet + j] + zero);
    }
    return { different, miscounted };
}
