// SPDX-License-Identifier: MIT
// How long frames and steps of the live page take, drawn in software at 960 x 540: TSV. Nothing is judged.
//
// usage: node times.mjs FOLDER [SECONDS]     the folder that tools/live has written; on a quiet machine
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";

import { presets } from "../page/presets.mjs";
import { launch, open } from "./browser.mjs";

const [folder, seconds = "5"] = process.argv.slice(2);
const browser = await launch();
const page = await open(browser, pathToFileURL(join(resolve(folder), "index.html")).href, {
    viewport: { width: 1400, height: 900 },
});
await page.addStyleTag({ content: "#stage { width: 960px !important; height: 540px !important }" });

const part = (list, q) => list.sort((a, b) => a - b)[Math.min(list.length - 1, Math.floor(q * list.length))];
console.log("scene\tmethod\tsteps\tframe_ms_median\tframe_ms_p95\tdraw_ms_median\tsimulation_us");
for (const scene of Object.keys(presets))
    for (const method of ["leapfrog", "rk4"]) {
        await page.selectOption("#scene", scene);
        await page.selectOption("#method", method);
        await page.selectOption("#speed", "1"); // slow motion would take fewer steps
        await page.click("#reset");
        if ((await page.textContent("#pause")) === "Play") await page.click("#pause");
        await page.waitForTimeout(1000);
        await page.evaluate(() => {
            const { intervals, drawings } = window.springstepLab.times();
            intervals.length = drawings.length = 0;
        });
        await page.waitForTimeout(1000 * Number(seconds));
        const { intervals, drawings, micros } = await page.evaluate(() => window.springstepLab.times());
        const numbers = [part(intervals, 0.5), part(intervals, 0.95), part(drawings, 0.5)].map((ms) =>
            ms.toFixed(2),
        );
        console.log([scene, method, presets[scene].steps, ...numbers, micros[0].toFixed(0)].join("\t"));
    }
await browser.close();
