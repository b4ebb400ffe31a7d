// SPDX-License-Identifier: MIT
// Times of steps of the live page compared with plain JavaScript, and times of frames rendered in software at 960 x
// 540: two tables in TSV. There is no verdict.
//
// usage: node times.mjs FOLDER [SECONDS]     the output folder of tools/live; use a quiet machine
import assert from "node:assert/strict";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { presets } from "../page/presets.mjs";
import { Lab } from "../page/lab.mjs";
import { launch, open } from "./browser.mjs";
import { Plain } from "./plain.mjs";

const [folder, seconds = "5"] = process.argv.slice(2);

// --- steps, in Node.js, which has the same engine as Chromium ---------------------------------------------------------

// Ten frames per call, since the page also requests energy and positions once per frame.
const frames = 10;

// Microseconds per frame, the minimum of many runs, alternating between both.
function framesOf(scene, size, mass, stiffness, gravity) {
    const { steps } = presets[scene];
    const dt = 1 / (60 * steps);
    const lab = new Lab({ scene, size, drag: 0, calm: true });
    const plain = new Plain(lab, mass, stiffness, gravity);
    const both = [
        () => lab.advance("leapfrog", steps, frames * steps),
        () => plain.advance(dt, frames * steps),
    ];
    const least = [Infinity, Infinity];
    for (let round = 0; round < 150; round++)
        both.forEach((advance, i) => {
            const start = process.hrtime.bigint();
            advance();
            least[i] = Math.min(least[i], Number(process.hrtime.bigint() - start) / 1000 / frames);
            if (round === 0 && i === 1) compare(lab, plain, dt); // before rounding errors grow
        });
    const { links } = lab;
    lab.free();
    return [scene, size, links, steps, ...least.map((us) => us.toFixed(0)), (least[1] / least[0]).toFixed(2)];
}

// The drawn state is at most one step behind.
function compare(lab, plain, dt) {
    const ours = lab.positions(1);
    const last = ours.length - 1; // a fallen corner, or water at rest
    const theirs = plain.x.at(-1);
    assert.ok(
        Math.abs(ours[last] - theirs) <= 1.01 * dt * Math.abs(plain.v.at(-1)) + 1e-6,
        `${ours[last]} m, ${theirs} m`,
    );
}

console.log("scene\tsize\tlinks\tsteps\tpackage_us\tplain_us\tspeedup");
for (const size of [25, 35, 50]) {
    console.log(framesOf("cloth", size, 0.01, 500, 9.81).join("\t"));
    console.log(framesOf("water", size, 1, 25000, 0).join("\t"));
}

// --- frames, in Chromium ----------------------------------------------------------------------------------------------

const browser = await launch();
const page = await open(browser, pathToFileURL(join(resolve(folder), "index.html")).href, {
    viewport: { width: 1400, height: 900 },
});
await page.addStyleTag({ content: "#stage { width: 960px !important; height: 540px !important }" });

const part = (list, q) => list.sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(q * list.length))];
console.log("scene\tmethod\tsteps\tframe_ms_median\tframe_ms_p95\tdraw_ms_median\tsimulation_us\tsharpness");
for (const scene of Object.keys(presets))
    for (const method of ["leapfrog", "rk4"]) {
        await page.selectOption("#scene", scene);
        await page.selectOption("#method", method);
        await page.selectOption("#speed", "1"); // slow motion takes fewer steps
        await page.click("#reset");
        if ((await page.textContent("#pause")) === "Play") await page.click("#pause");
        await page.waitForTimeout(1000);
        await page.evaluate(() => {
            const { intervals, drawings } = window.springstepLab.times();
            intervals.length = drawings.length = 0;
        });
        await page.waitForTimeout(1000 * Number(seconds));
        const { intervals, drawings, micros, sharpness } = await page.evaluate(() =>
            window.springstepLab.times(),
        );
        const numbers = [part(intervals, 0.5), part(intervals, 0.95), part(drawings, 0.5)].map((ms) =>
            ms.toFixed(2),
        );
        console.log(
            [
                scene,
                method,
                presets[scene].steps,
                ...numbers,
                micros[0].toFixed(0),
                sharpness.toFixed(2),
            ].join("\t"),
        );
    }
await browser.close();
