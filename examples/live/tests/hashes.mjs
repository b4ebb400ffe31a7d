// SPDX-License-Identifier: MIT
// Checks that the labs of the live page are bit-identical to spring-scene: each scene with each method, 600 frames with
// a scripted poke, and scenes with settings of the controls.
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { readFileSync } from "node:fs";

import { readPresets } from "../../../tools/scenes/presets.mjs";
import { Lab, methodTable } from "../page/lab.mjs";
import { commandOf, heavyEnd, heavySteps, presets } from "../page/presets.mjs";
import { Cases } from "./harness.mjs";

readPresets(readFileSync(new URL("../../../tools/scenes/presets.c", import.meta.url), "utf8"));
const frames = 600;
const pokeAt = 37; // frames

/** The output of spring-scene --hash; status 1 is a scene that overflows. */
export function native(tool, run, method, steps, duration, poke = []) {
    const words = [...commandOf(run, method, steps, duration).slice(1), ...poke];
    return new Promise((resolve, reject) =>
        execFile(tool, words, (error, out, complaint) => {
            if (error && error.code !== 1) reject(new Error(complaint));
            else resolve(out.trim());
        }),
    );
}

/** The poke of a scene: [x, y, force, area]. */
export function pokeOf(scene, length) {
    const along = scene === "rope" ? 0 : 0.3 * length;
    return [0.4 * length, along, scene === "water" ? 5e4 : 2, (length * length) / 20];
}

function inLab(run, method, steps) {
    const lab = new Lab({ ...run, calm: true }); // without a poke, spring-scene would add its default one
    lab.poke(...pokeOf(run.scene, lab.length), pokeAt / 60); // added at the start, as in spring-scene
    for (let frame = 0; frame < frames; frame++) if (lab.advance(method, steps, steps) < steps) break;
    const hash = lab.hash();
    lab.free();
    return hash;
}

export async function testHashes(tool) {
    const runs = Object.keys(presets)
        .filter((scene) => !presets[scene].own)
        .map((scene) => ({ scene }));
    const further = [
        { scene: "rope", ...heavyEnd },
        { scene: "cloth", size: 12, damping: 0.01, drag: 0.02 },
        { scene: "water", size: 40, drag: 2 },
    ];
    const cases = new Cases("bits");
    for (const run of [...runs, ...further]) {
        const lab = new Lab(run);
        const poke = ["--poke", [pokeAt / 60, ...pokeOf(run.scene, lab.length)].join(",")];
        const methods = [...methodTable.keys()].filter((method) => lab.takes(method));
        lab.free();
        for (const method of methods)
            await cases.case(`${JSON.stringify(run)} ${method}`, async () => {
                const steps = run.endMass ? heavySteps : presets[run.scene].steps;
                const wanted = await native(tool, run, method, steps, frames / 60, poke);
                assert.match(wanted, /^[0-9a-f]{16}$/);
                assert.equal(inLab(run, method, steps), wanted);
            });
    }
    await cases.case("a scene that is not there is refused, and sizes that cannot be", () => {
        assert.throws(() => new Lab({ scene: "nonsense" }), /no scene "nonsense"/);
        for (const size of [1e5, -1, 0.5, 1])
            assert.throws(() => new Lab({ scene: "cloth", size }), RangeError);
    });
    await cases.case("a scene that explodes is drawn as it was last", () => {
        const lab = new Lab({ scene: "water" });
        const [steps, many] = [1, 1000];
        assert.ok(lab.advance("euler", steps, many) < many);
        const drawn = lab.positions(steps);
        lab.advance("euler", steps, 1); // explodes at once, so both states for drawing are the last one
        assert.deepEqual(drawn, lab.positions(steps));
        assert.ok(drawn.every((x) => !Number.isNaN(x)));
        lab.free();
    });
    return cases;
}
