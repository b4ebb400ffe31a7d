// SPDX-License-Identifier: MIT
// Headless Chromium for the tests, with software WebGL and without network requests.
import { chromium } from "playwright-core";

const flags = [
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--enable-unsafe-swiftshader",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
];

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
