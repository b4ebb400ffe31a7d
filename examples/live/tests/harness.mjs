// SPDX-License-Identifier: MIT
// Cases that run one after the other and are counted, and headless Chromium for them, with software WebGL and without
// network requests.
import { execFile } from "node:child_process";

import { chromium } from "playwright-core";

import { commandOf } from "../page/presets.mjs";

let passed = 0;
let failed = 0;

export async function test(name, run) {
    const start = Date.now();
    try {
        await run();
        passed++;
        console.log(`ok - ${name} (${Date.now() - start} ms)`);
    } catch (error) {
        failed++;
        console.log(`not ok - ${name}\n    ${`${error.stack}`.replaceAll("\n", "\n    ")}`);
    }
}

export function done() {
    console.log(`${passed} passed, ${failed} failed, 0 skipped`);
    process.exit(failed === 0 && passed > 0 ? 0 : 1);
}

export async function until(what, holds, seconds = 20) {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end;) {
        if (await holds()) return;
        await new Promise((resolve) => setTimeout(resolve, 50));
    }
    throw new Error(`waited ${seconds} s for: ${what}`);
}

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

const flags = `--headless --no-sandbox --disable-gpu --enable-unsafe-swiftshader --disable-quic --no-first-run
    --disable-background-networking --disable-component-update --disable-sync`.split(/\s+/);

export function launch() {
    return chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: flags });
}

/** Opens a page and waits until it is ready. page.complaints keeps console messages and network requests. */
export async function open(browser, url, how = {}, before = null) {
    const context = await browser.newContext({ viewport: { width: 1280, height: 860 }, ...how });
    const page = await context.newPage();
    page.complaints = [];
    page.on("console", (message) => {
        const screenshot = message.text().includes("GL Driver Message"); // a performance warning
        if (["error", "warning"].includes(message.type()) && !screenshot)
            page.complaints.push(message.text());
    });
    page.on("pageerror", (error) => page.complaints.push(`${error}`));
    page.on("request", (request) => {
        if (!request.url().startsWith("blob:") && !request.url().startsWith("data:") && request.url() !== url)
            page.complaints.push(`request for ${request.url()}`);
    });
    if (before) await page.addInitScript(before);
    await page.goto(url);
    await page.waitForFunction(() => document.querySelector(".pane .name")?.textContent);
    return page;
}
