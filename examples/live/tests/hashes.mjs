// SPDX-License-Identifier: MIT
// Has the module of the live page, with and without SIMD, the bits of spring-scene? Each scene with each method, 600
// frames with a scripted poke, and scenes as the page's controls make them. Prints TAP.
//
// usage: node hashes.mjs FOLDER-OF-MODULES SPRING-SCENE
import { spawnSync } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";

import { Module } from "../page/module.mjs";
import { commandOf, heavyEnd, heavySteps, presets } from "../page/presets.mjs";

const [folder, tool] = process.argv.slice(2);
const frames = 600;
const pokeAt = 37; // frames

function native(run, method, steps, poke) {
    const duration = frames / 60;
    const done = spawnSync(tool, [...commandOf(run, method, steps, duration).slice(1), ...poke], {
        encoding: "utf8",
    });
    return done.stdout.trim();
}

function pokeOf(lab, run) {
    const { length } = lab;
    const along = run.scene === "rope" ? 0 : 0.3 * length;
    return [0.4 * length, along, run.scene === "water" ? 5e4 : 2, (length * length) / 20];
}

function inModule(module, run, method, steps) {
    const lab = module.make({ ...run, calm: true }); // spring-scene pokes water that is not poked
    lab.poke(...pokeOf(lab, run), pokeAt / 60); // known from the start, as spring-scene knows it
    for (let frame = 0; frame < frames; frame++) if (lab.advance(method, steps, steps) < steps) break;
    const hash = lab.hash();
    lab.free();
    return hash;
}

const runs = Object.keys(presets).map((scene) => ({ scene }));
runs.push({ scene: "rope", ...heavyEnd });
runs.push({ scene: "cloth", size: 12, damping: 0.01, drag: 0.02 });
runs.push({ scene: "water", size: 40, drag: 2 });

const modules = [];
for (const name of ["lab.wasm", "lab-nosimd.wasm"])
    modules.push({ name, module: await Module.load(readFileSync(join(folder, name))) });

let count = 0;
let failed = 0;
for (const run of runs) {
    const trial = modules[0].module.make(run);
    const methods = modules[0].module.methods.filter((method) => trial.takes(method));
    const poke = ["--poke", [pokeAt / 60, ...pokeOf(trial, run)].join(",")];
    trial.free();
    for (const method of methods) {
        const steps = run.endMass ? heavySteps : presets[run.scene].steps;
        const wanted = native(run, method, steps, poke);
        for (const { name, module } of modules) {
            const hash = inModule(module, run, method, steps);
            const same = /^[0-9a-f]{16}$/.test(wanted) && hash === wanted;
            failed += !same;
            const what = `${name}: ${JSON.stringify(run)} ${method}`;
            console.log(`${same ? "ok" : "not ok"} ${++count} - ${what}: ${hash}, spring-scene ${wanted}`);
        }
    }
}
console.log(`1..${count}`);
process.exit(failed ? 1 : 0);
