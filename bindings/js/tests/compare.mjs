// SPDX-License-Identifier: MIT
// Random springs, single and in sets, against the C library: every bit of value and velocity after each step.
import assert from "node:assert";
import { spawnSync } from "node:child_process";
import { Spring, Springs } from "../index.js";
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

/** mass, stiffness, damping, dt, two tolerances, values, velocities, targets */
function setRecord(record) {
    const p = usual();
    const near = chance(0.3) ? logarithmic(1e-13, 1e-6) : chance(0.3) ? 0.01 : 1000;
    const tolerance = chance(0.5) ? 0 : 0.001;
    if (chance(0.05)) p.stiffness = 0;
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
        record[6 + 2 * perSet + i] = bits() % 200 === 0 ? [NaN, Infinity, 1.5e308][bits() % 3] : target;
    }
}

/** How many of `count` springs, in sets of 64, differ; and of how many sets the number that still move. */
export function compareSets(program, count) {
    let different = 0;
    let miscounted = 0;
    const size = 6 + 3 * perSet;
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
        s.target.set(r.subarray(6 + 2 * perSet));
        const [wantMoving, status] = expected.subarray(2 * perSet);
        let moving = -1;
        try {
            moving = s.step(dt);
        } catch (error) {
            if (!(error instanceof RangeError)) throw error;
        }
        miscounted += moving !== (status === 0 ? wantMoving : -1);
        for (let j = 0; j < perSet; j++)
            different +=
                !Object.is(s.value[j], expected[j]) || !Object.is(s.velocity[j], expected[perSet + j]);
    }
    return { different, miscounted };
}
