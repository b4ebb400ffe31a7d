// SPDX-License-Identifier: MIT
// The live page in Chromium: bit-identical results, methods, dragging, explosions, sizes, error recovery. The last line
// counts the tests: "N passed, N failed, N skipped".
//
// usage: node page.mjs FOLDER SPRING-SCENE     the output folder of tools/live
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

import { presets, sentences } from "../page/presets.mjs";
import { done, launch, native, open, pokeOf, test, until } from "./harness.mjs";

const [folder, tool] = process.argv.slice(2, 4).map((path) => resolve(path));
const url = pathToFileURL(join(folder, "index.html")).href;
const browser = await launch();
const page = await open(browser, url);

const ask = (page, question, ...parameters) =>
    page.evaluate(([q, p]) => window.springstepLab[q](...p), [question, parameters]);

async function choose(page, scene, method, steps) {
    await page.selectOption("#scene", scene);
    if (method) await page.selectOption("#method", method);
    if (steps) await page.fill("#steps", `${steps}`);
    await begin(page);
}

const runOf = (scene) => ({ scene, ...presets[scene].more });

/** Restarts and pauses the page. */
async function begin(page) {
    if ((await page.textContent("#pause")) === "Pause") await page.click("#pause");
    await page.click("#reset");
    await until("the start", async () => (await ask(page, "time")) === 0);
}

const methodsOf = (page) =>
    page.$$eval("#method option", (options) =>
        options.filter((each) => !each.disabled).map((each) => each.value),
    );

/** The number of colours in a picture of the scene. */
async function colours(page) {
    const picture = (await page.locator("#stage").screenshot()).toString("base64");
    return page.evaluate(async (data) => {
        const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${data}`)).blob());
        const context = new OffscreenCanvas(image.width, image.height).getContext("2d");
        context.drawImage(image, 0, 0);
        const { data: pixels } = context.getImageData(0, 0, image.width, image.height);
        return new Set(new Uint32Array(pixels.buffer)).size;
    }, picture);
}

const energyAfter = async (page, frames) => {
    await ask(page, "step", frames);
    return ask(page, "energy");
};

// --- methods

await test("the switch changes the motion, while it runs", async () => {
    const ends = new Set();
    for (const second of ["leapfrog", "euler", "rk4"]) {
        await choose(page, "cloth", "leapfrog");
        await ask(page, "step", 20);
        await page.selectOption("#method", second);
        assert.ok((await ask(page, "time")) > 0.3, "it goes on from where it was");
        await ask(page, "step", 20);
        ends.add(await ask(page, "hash"));
    }
    assert.equal(ends.size, 3);
});
for (const [method, order, steps] of [
    ["euler", 1, 400],
    ["symplectic-euler", 1, 100],
    ["leapfrog", 2, 40],
    ["rk4", 4, 20],
])
    await test(`order ${order} of ${method} against the reference`, async () => {
        await page.selectOption("#scene", "rope");
        await page.check("#reference");
        const errors = [];
        for (const n of [steps, 2 * steps]) {
            await choose(page, "rope", method, n);
            await ask(page, "step", 6);
            errors.push(await ask(page, "difference"));
        }
        const slope = Math.log2(errors[0] / errors[1]);
        await page.uncheck("#reference");
        assert.ok(Math.abs(slope - order) <= 0.15, `slope ${slope}, errors ${errors}`);
    });

// --- input before a new scene has arrived

/** Chooses values of selects, all before the worker answers. */
const set = (page, ...choices) =>
    page.evaluate((all) => {
        for (const [id, value] of all) {
            const select = document.getElementById(id);
            select.value = value;
            select.dispatchEvent(new Event("change"));
        }
    }, choices);

await test("a method that the next scene does not support is replaced", async () => {
    await choose(page, "cloth", "leapfrog");
    await set(page, ["scene", "curtain"], ["method", "euler"]);
    await ask(page, "step", 2);
    assert.equal(await page.inputValue("#method"), "leapfrog");
});
await test("a scene that is replaced before it arrives changes no setting", async () => {
    await choose(page, "cloth", "leapfrog");
    await set(page, ["scene", "curtain"], ["scene", "rope"], ["method", "euler"]);
    await ask(page, "step", 2);
    assert.equal(await page.inputValue("#method"), "euler");
});
await test("a press before the new scene arrives holds nothing", async () => {
    await choose(page, "rope", "leapfrog");
    await ask(page, "step", 1);
    const end = 19;
    const start = await ask(page, "position", end);
    const point = await ask(page, "pixel", end);
    const press = (kind) =>
        page.evaluate(
            ([type, [x, y]]) => {
                const canvas = document.getElementById("canvas");
                const { left, top } = canvas.getBoundingClientRect();
                if (type === "pointerdown") document.getElementById("reset").click();
                canvas.dispatchEvent(new PointerEvent(type, { clientX: left + x, clientY: top + y }));
            },
            [kind, point],
        );
    await press("pointerdown");
    assert.equal(await ask(page, "time"), 0);
    await press("pointerup");
    await ask(page, "step", 30);
    assert.ok((await ask(page, "position", end))[2] < start[2] - 0.1, "it falls");
    assert.ok(await ask(page, "command"), "it was not touched");
});

// --- the command

const shown = () => page.$eval("#no-command", (none) => none.hidden);
const changes = {
    "a poke": () => page.click("#poke"),
    "another method": () => page.selectOption("#method", "rk4"),
    "other steps": () => page.click("#more"),
};
for (const [name, change] of Object.entries(changes))
    await test(`no command is shown after ${name} on the way`, async () => {
        await choose(page, "cloth", "leapfrog", presets.cloth.steps);
        await ask(page, "step", 5);
        assert.ok((await shown()) && (await ask(page, "command")));
        await change();
        assert.ok(!(await shown()) && !(await page.textContent("#command")));
        await begin(page);
        assert.ok(await shown());
    });
await test("no command is shown where wind blows from the start", async () => {
    await choose(page, "cloth", "leapfrog");
    await page.fill("#wind", "6");
    await begin(page);
    assert.equal(await shown(), false);
    await page.fill("#wind", "0");
    await begin(page);
    assert.equal(await shown(), true);
});

// --- hands

const box = await page.locator("#canvas").boundingBox();
await test("a pointer grabs the particle under it, pulls it and lets it go", async () => {
    await choose(page, "rope", "leapfrog");
    await ask(page, "step", 1);
    const end = 19;
    const [x, y] = await ask(page, "pixel", end);
    await page.mouse.move(box.x + x, box.y + y);
    await page.mouse.down();
    await page.mouse.move(box.x + x - 90, box.y + y + 40, { steps: 4 });
    await ask(page, "step", 60);
    const [heldX, heldY] = await ask(page, "pixel", end);
    assert.ok(Math.hypot(heldX - x + 90, heldY - y - 40) < 3, `is at ${heldX - x}, ${heldY - y}`);
    const held = await ask(page, "position", end);
    await ask(page, "step", 1);
    assert.deepEqual(await ask(page, "position", end), held);
    await page.mouse.up();
    await ask(page, "step", 30);
    assert.ok((await ask(page, "position", end))[2] < held[2] - 0.1, "it falls");
});
await test("beside the scene a pointer turns the view, and touches nothing", async () => {
    await choose(page, "rope", "leapfrog");
    const [before] = await ask(page, "pixel", 19);
    await page.mouse.move(box.x + 30, box.y + box.height - 30);
    await page.mouse.down();
    await page.mouse.move(box.x + 130, box.y + box.height - 30, { steps: 3 });
    await page.mouse.up();
    const [after] = await ask(page, "pixel", 19);
    assert.ok(Math.abs(after - before) > 5);
    assert.equal(await ask(page, "time"), 0);
});
await test("a cloth tears where it is pulled hard, and is cut by scissors", async () => {
    await choose(page, "cloth", "leapfrog");
    await ask(page, "step", 100);
    assert.equal(await ask(page, "tornLinks"), 0);
    const [x, y] = await ask(page, "pixel", 12 * 25 + 12);
    await page.click("#scissors");
    await page.mouse.click(box.x + x, box.y + y);
    const cut = await ask(page, "tornLinks");
    assert.ok(cut >= 8 && cut <= 12, `${cut} links of one particle`);
    assert.equal(await ask(page, "cutTethers"), 1);
    const [, , height] = await ask(page, "position", 12 * 25 + 12);
    await ask(page, "step", 30);
    const [, , lower] = await ask(page, "position", 12 * 25 + 12);
    assert.ok(lower < height - 0.7, `it falls by ${height - lower} m`);
    await page.click("#scissors");
    const [cx, cy] = await ask(page, "pixel", 24 * 25);
    await page.mouse.move(box.x + cx, box.y + cy);
    await page.mouse.down();
    await page.mouse.move(box.x + 10, box.y + box.height - 10, { steps: 3 });
    for (let i = 0; i < 60; i++) await ask(page, "step", 1);
    await page.mouse.up();
    assert.ok((await ask(page, "tornLinks")) > cut);
});
await test("a sphere is pushed through the curtain, which tears", async () => {
    await choose(page, "curtain", "leapfrog");
    await ask(page, "step", 60);
    assert.equal(await ask(page, "tornLinks"), 0);
    assert.equal(await ask(page, "command"), "");
    const [x, y] = await ask(page, "pixel", 12 * 25 + 12);
    await page.mouse.move(box.x + x, box.y + y);
    await page.mouse.down();
    let least = Infinity;
    let deepest = -Infinity;
    for (let i = 0; i < 45; i++) {
        await ask(page, "step", 1);
        const at = await ask(page, "position", 12 * 25 + 12);
        deepest = Math.max(deepest, at[1]);
        const sphere = await ask(page, "sphere");
        least = Math.min(least, Math.hypot(...at.map((each, axis) => each - sphere[axis])) - sphere[3]);
    }
    await page.mouse.up();
    assert.ok(deepest > 0.2, `the curtain is pushed by ${deepest} m`);
    assert.ok(least > -1e-6, `a particle is ${-least} m inside the sphere`);
    await ask(page, "step", 120);
    assert.ok((await ask(page, "tornLinks")) > 10);
    assert.equal(await ask(page, "sphere"), null);
});
await test("no method without contacts is offered for the curtain", async () => {
    await choose(page, "curtain", "leapfrog");
    const offered = await methodsOf(page);
    assert.deepEqual([...offered].sort(), ["leapfrog", "rk4", "symplectic-euler"]);
});
await test("the keyboard pokes", async () => {
    await choose(page, "water", "leapfrog");
    await page.focus("#canvas");
    const calm = await energyAfter(page, 20);
    for (const key of ["ArrowRight", "ArrowDown", "Enter"]) await page.keyboard.press(key);
    assert.ok(await page.locator("#cursor").isVisible());
    assert.ok((await energyAfter(page, 3)) > 1.05 * calm);
    const place = () => page.locator("#cursor").boundingBox();
    const before = await place();
    await page.keyboard.press("Control+ArrowLeft");
    assert.deepEqual(await place(), before, "shortcuts of the browser move nothing");
});
await test("the keyboard grabs, pulls and lets go", async () => {
    await choose(page, "rope", "leapfrog");
    await page.evaluate(() => document.activeElement.blur());
    await page.focus("#canvas");
    await ask(page, "step", 1);
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("Enter");
    for (let i = 0; i < 6; i++) await page.keyboard.press("ArrowUp");
    await ask(page, "step", 60);
    const held = await ask(page, "position", 19);
    assert.ok(held[2] > 0.2, `pulled up to ${held[2]}`);
    await page.keyboard.press("Escape");
    await ask(page, "step", 30);
    assert.ok((await ask(page, "position", 19))[2] < held[2] - 0.1);
});
await test("rain, wind and the ball move the scene", async () => {
    for (const [scene, touch] of [
        ["water", () => page.click("#rain")],
        ["water", () => page.click("#ball")],
        ["cloth", () => page.fill("#wind", "8")],
    ]) {
        const ends = [];
        for (const doing of [false, true]) {
            await choose(page, scene, "leapfrog");
            if (doing) await touch();
            await ask(page, "step", 60);
            ends.push(await ask(page, "hash"));
        }
        assert.notEqual(ends[0], ends[1], `${touch}`);
    }
});

// --- numbers that are not offered

await test("numbers of steps that are not offered are limited, which is said", async () => {
    await choose(page, "cloth", "leapfrog");
    for (const [value, used] of [
        ["100000", 1000],
        ["-1", 1],
        ["", presets.cloth.steps],
    ]) {
        await page.fill("#steps", value);
        await page.press("#steps", "Enter");
        assert.equal(await page.inputValue("#steps"), `${used}`);
        assert.match(await page.textContent("#notice"), /not offered/);
    }
    await page.click("#reset");
    await until("reset clears it", async () => (await page.textContent("#notice")) === "paused");
});

await test("a typed number of steps is used when it is complete", async () => {
    await choose(page, "cloth", "leapfrog", presets.cloth.steps);
    const step = () => page.textContent("#numbers td");
    const before = await step();
    await page.click("#steps", { clickCount: 3 });
    await page.keyboard.type("20");
    assert.equal(await step(), before, "after each key");
    await page.keyboard.press("Enter");
    assert.match(await step(), /^0\.833\sms$/, "after Enter");
    await page.keyboard.press("ArrowUp");
    assert.match(await step(), /^0\.794\sms$/, "after an arrow key");
});

// --- explosions

await test("an explosion is said with its time, and one click starts again", async () => {
    await choose(page, "water", "euler", 2);
    await page.selectOption("#speed", "1");
    await page.click("#pause");
    await page.locator(".boom").waitFor({ state: "visible", timeout: 20000 });
    assert.ok((await ask(page, "pixel", 300)).every(Number.isFinite), "it is drawn as it was last");
    assert.match(await page.textContent(".boom"), /Euler exploded after \d+\.\d\d s\..*stable step/);
    await page.selectOption("#method", "leapfrog");
    await page.fill("#steps", "13");
    await page.click(".again");
    await page.locator(".boom").waitFor({ state: "hidden" });
    await until("it runs again", async () => (await ask(page, "time")) > 0.1);
    assert.ok(!(await page.locator(".boom").isVisible()));
});
await test("side by side one explodes, and the other goes on", async () => {
    await choose(page, "water", "leapfrog");
    await page.selectOption("#other", "euler");
    await page.selectOption("#speed", "1");
    await page.click("#pause");
    await page.locator(".pane:nth-child(2) .boom").waitFor({ state: "visible", timeout: 40000 });
    assert.deepEqual(await page.locator(".pane .name").allTextContents(), ["Leapfrog", "Euler"]);
    assert.ok(!(await page.locator(".pane:nth-child(1) .boom").isVisible()));
    const time = await ask(page, "time");
    await until("leapfrog goes on", async () => (await ask(page, "time")) > time + 0.1);
    await page.selectOption("#other", "");
});

await test("a heavy scene runs slower than real time, and the page answers between short ticks", async () => {
    await page.check("#reference");
    await choose(page, "jelly", "rk4", 1000);
    await page.selectOption("#size", "10");
    await page.selectOption("#other", "rk4");
    await begin(page);
    await page.click("#pause");
    await until("the first tick", async () => (await ask(page, "time")) > 0);
    const first = await ask(page, "time");
    await until("the next tick", async () => (await ask(page, "time")) > first);
    const second = await ask(page, "time");
    assert.ok(second < 0.01, `${first} s, then ${second} s`);
    await page.selectOption("#other", "");
    await page.uncheck("#reference");
});

// --- windows and failures

await test("every scene is drawn, also in a narrow window, which has no room to scroll sideways", async () => {
    for (const [width, height, least] of [
        [390, 844, 800],
        [1280, 860, 1500],
    ]) {
        await page.setViewportSize({ width, height });
        for (const scene of Object.keys(presets)) {
            await choose(page, scene, "leapfrog");
            await ask(page, "step", 5);
            await page.waitForTimeout(150);
            const wide = await page.evaluate(() => document.scrollingElement.scrollWidth);
            assert.ok(wide <= width, `${scene} is ${wide} px wide`);
            const many = await colours(page);
            assert.ok(many > least, `${scene} has ${many} colours`);
        }
        const [css, drawn] = await page.$eval("#canvas", (canvas) => [canvas.clientWidth, canvas.width]);
        assert.ok(drawn >= 0.5 * css && drawn <= 2 * css, `${drawn} pixels for ${css}`);
    }
});
await test("fewer pixels are rendered where drawing is slow, not where the physics is slow", async () => {
    const small = await open(browser, url, { viewport: { width: 320, height: 400 } }, () => {
        window.ticks = window.drawing = 0; // drawing: its time [ms], in place of that of software rendering
        WebGL2RenderingContext.prototype.readPixels = () => {
            for (const end = performance.now() + window.drawing; performance.now() < end;);
        };
        const post = Worker.prototype.postMessage;
        Worker.prototype.postMessage = function (message) {
            if (message.kind === "tick") window.ticks++;
            setTimeout(() => post.call(this, message), message.kind === "tick" ? 30 : 0);
        };
    });
    const pixels = () => small.$eval("#canvas", (canvas) => canvas.width / canvas.clientWidth);
    await small.selectOption("#scene", "rope"); // which is drawn quickly
    await until("many pictures", () => small.evaluate(() => window.ticks > 100));
    assert.equal(await pixels(), 1, "with slow physics");
    await small.evaluate(() => (window.drawing = 30));
    await small.click("#reset");
    await until("fewer pixels", async () => (await pixels()) < 1);
    await small.evaluate(() => (window.drawing = 0));
    await begin(small);
    assert.equal(await pixels(), 1, "with a new scene");
    const devtools = await small.context().newCDPSession(small);
    const screen = { width: 320, height: 400, deviceScaleFactor: 2, mobile: false };
    await devtools.send("Emulation.setDeviceMetricsOverride", screen);
    await until("more pixels", async () => (await pixels()) === 2);
    await small.context().close();
});
await test("a lost context comes back", async () => {
    await choose(page, "water", "leapfrog");
    await page.evaluate(() => {
        const context = document.getElementById("canvas").getContext("webgl2");
        window.loser = context.getExtension("WEBGL_lose_context");
        window.loser.loseContext();
    });
    await page.waitForTimeout(200);
    await ask(page, "step", 5);
    const blank = await colours(page);
    await page.evaluate(() => window.loser.restoreContext());
    await page.waitForTimeout(300);
    await ask(page, "step", 5);
    await page.waitForTimeout(150);
    const many = await colours(page);
    assert.ok(many > 1500 && blank < many / 2, `${blank} colours without, ${many} with a context`);
});
await test("fingers poke and pull", async () => {
    const how = { viewport: { width: 390, height: 844 }, hasTouch: true, isMobile: true };
    const phone = await open(browser, url, how);
    const box = await phone.locator("#canvas").boundingBox();
    await begin(phone);
    const calm = await energyAfter(phone, 20);
    await phone.touchscreen.tap(box.x + box.width / 2, box.y + box.height / 2);
    assert.ok((await energyAfter(phone, 3)) > 1.05 * calm, "poke");
    await choose(phone, "jelly", "leapfrog");
    const corner = 511;
    await ask(phone, "step", 1);
    const [x, y] = await ask(phone, "pixel", corner);
    const start = await ask(phone, "position", corner);
    const devtools = await phone.context().newCDPSession(phone);
    const touch = (type, dx) =>
        devtools.send("Input.dispatchTouchEvent", {
            type,
            touchPoints: type === "touchEnd" ? [] : [{ x: box.x + x + dx, y: box.y + y }],
        });
    await touch("touchStart", 0);
    await touch("touchMove", 30);
    await touch("touchMove", 60);
    await ask(phone, "step", 30);
    const pulled = await ask(phone, "position", corner);
    assert.ok(Math.hypot(...pulled.map((each, k) => each - start[k])) > 0.1, "pull");
    await touch("touchEnd", 0);
    await ask(phone, "step", 30);
    assert.notDeepEqual(await ask(phone, "position", corner), pulled, "let go");
    assert.deepEqual(phone.complaints, []);
    await phone.context().close();
});
await test("a page without WebGL 2 says so", async () => {
    const context = await browser.newContext();
    const bare = await context.newPage();
    await bare.addInitScript(() => (HTMLCanvasElement.prototype.getContext = () => null));
    await bare.goto(url);
    assert.match(await bare.textContent("#notice"), /WebGL 2/);
    await context.close();
});
await test("a page without SIMD for WebAssembly says so, and ignores input", async () => {
    const context = await browser.newContext();
    const bare = await context.newPage();
    const thrown = [];
    bare.on("pageerror", ({ message }) => thrown.push(message));
    await bare.addInitScript(() => {
        const plain = URL.createObjectURL;
        URL.createObjectURL = (blob) => plain(new Blob(["WebAssembly.validate = () => false;", blob]));
    });
    await bare.goto(url);
    await until("it says so", async () => /cannot run: .*SIMD/.test(await bare.textContent("#notice")));
    assert.equal(await bare.locator("#bar").count(), 0);
    await bare.click("#canvas");
    await bare.keyboard.press("Enter");
    assert.ok(!(await bare.locator("#cursor").isVisible()));
    await bare.emulateMedia({ colorScheme: "dark" });
    await bare.waitForTimeout(100);
    assert.deepEqual(
        thrown.filter((message) => !message.includes("SIMD")),
        [],
    );
    await context.close();
});
const run = { scene: "cloth", size: 20000 };
for (const [message, said] of [
    [{ kind: "nonsense" }, /stopped/],
    [{ kind: "make", run, steps: 19, methods: ["leapfrog"] }, /stopped: .*no memory/],
])
    await test(`when its worker fails by "${message.kind}" the page says so, and reset begins anew`, async () => {
        const frail = await open(browser, url, {}, () => {
            const Plain = Worker;
            window.Worker = function (source) {
                return (window.lastWorker = new Plain(source));
            };
        });
        await choose(frail, "cloth", "leapfrog");
        await ask(frail, "step", 10);
        await frail.evaluate((order) => window.lastWorker.postMessage(order), message);
        await until("it says so", async () => said.test(await frail.textContent("#notice")));
        const thrown = [];
        frail.on("pageerror", (error) => thrown.push(`${error}`));
        await frail.click("#once");
        await frail.$eval("#hash", (button) => button.click());
        await frail.waitForTimeout(100);
        assert.deepEqual(thrown, []);
        await begin(frail);
        await ask(frail, "step", 60);
        const wanted = await native(tool, runOf("cloth"), "leapfrog", presets.cloth.steps, 1);
        assert.equal(await ask(frail, "hash"), wanted);
        assert.equal(await frail.textContent("#notice"), "paused");
        await frail.click("#pause");
        await until("it runs", async () => (await ask(frail, "time")) > 1);
        await frail.context().close();
    });
await test("it runs by itself, unless less motion is asked for; and is dark where that is asked for", async () => {
    const run = await open(browser, url, { colorScheme: "dark" });
    await until("it runs", async () => (await ask(run, "time")) > 0.01);
    const back = await run.evaluate(() => getComputedStyle(document.body).backgroundColor);
    const dark = back.match(/\d+/g).every((part) => part < 60);
    assert.ok(dark, back);
    await run.context().close();
    const still = await open(browser, url, { reducedMotion: "reduce" });
    await still.waitForTimeout(500);
    assert.equal(await ask(still, "time"), 0);
    assert.equal(await still.textContent("#pause"), "Play");
    await still.click("#pause");
    await until("it runs when asked", async () => (await ask(still, "time")) > 0);
    await still.context().close();
});

await test("a change of the colour scheme keeps the plots", async () => {
    await page.emulateMedia({ colorScheme: "light" });
    await choose(page, "rope", "leapfrog");
    await ask(page, "step", 5);
    await ask(page, "step", 5);
    // pixels of the plot in the colour of the first pane
    const drawn = () =>
        page.evaluate(() => {
            const canvas = document.querySelector("#energy-plot canvas");
            const ink = getComputedStyle(document.querySelector(".pane .name")).color.match(/\d+/g);
            const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
            copy.drawImage(canvas, 0, 0);
            const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
            let count = 0;
            for (let i = 0; i < data.length; i += 4) count += ink.every((each, k) => data[i + k] === +each);
            return count;
        });
    await until("a line", async () => (await drawn()) > 50);
    await page.emulateMedia({ colorScheme: "dark" });
    await until("a line in the other colour", async () => (await drawn()) > 50);
    await page.emulateMedia({ colorScheme: "light" });
});
await test("names of methods have a contrast of 4.5, and pressed buttons differ in forced colours", async () => {
    await page.selectOption("#other", "rk4");
    await until("two panes", async () => (await page.locator(".pane").count()) === 2);
    const styles = (what, ...names) =>
        page.$$eval(
            what,
            (all, names) => all.map((each) => names.map((name) => getComputedStyle(each)[name])),
            names,
        );
    // relative luminance, WCAG 2.2
    const luminance = (colour) => {
        const parts = colour.match(/[\d.]+/g).map((each) => each / 255);
        const linear = parts.map((x) => (x <= 0.04045 ? x / 12.92 : ((x + 0.055) / 1.055) ** 2.4));
        return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2];
    };
    for (const colorScheme of ["dark", "light"]) {
        await page.emulateMedia({ colorScheme });
        for (const colours of await styles(".pane .name", "color", "backgroundColor")) {
            const [dark, bright] = colours.map(luminance).sort((a, b) => a - b);
            const contrast = (bright + 0.05) / (dark + 0.05);
            assert.ok(contrast >= 4.5, `${colours} in ${colorScheme}: ${contrast}`);
        }
    }
    await choose(page, "cloth", "leapfrog");
    await page.click("#scissors");
    await page.emulateMedia({ forcedColors: "active" });
    const [[pressed], [other]] = await styles("#scissors, #poke", "backgroundColor");
    assert.notEqual(pressed, other);
    await page.emulateMedia({ forcedColors: "none" });
    await page.selectOption("#other", "");
});

// --- links

const root = fileURLToPath(new URL("../../..", import.meta.url));
await test("the page links to the report only if that exists", () => {
    const scratch = mkdtempSync(join(tmpdir(), "live-"));
    const [live, report] = ["live", "report"].map((name) => join(scratch, name));
    const links = () => {
        execFileSync("node", [join(root, "examples/live/bundle.mjs"), live]);
        return readFileSync(join(live, "index.html"), "utf8").includes("../report/");
    };
    try {
        mkdirSync(live);
        assert.equal(links(), false);
        mkdirSync(report);
        writeFileSync(join(report, "index.html"), "");
        assert.equal(links(), true);
    } finally {
        rmSync(scratch, { recursive: true });
    }
});
await test("the links lead to figures of the report", () => {
    const folder = join(root, "plots");
    const text = { index: "", evidence: "" }; // the templates of each page
    for (const name of readdirSync(folder).filter((each) => each.endsWith(".md.in")))
        text[name === "index.md.in" ? "index" : "evidence"] += readFileSync(join(folder, name), "utf8");
    for (const [, link] of Object.values(sentences)) {
        const [, page, figure] = link.match(/^(\w+)\.html#(.+)$/);
        assert.ok(text[page].includes(`figure('${figure}'`), link);
    }
});

// --- bits

const frames = 600;
const pokeAt = 37;
for (const scene of Object.keys(presets).filter((each) => !presets[each].own)) {
    await choose(page, scene);
    for (const method of await methodsOf(page))
        await test(`the bits of spring-scene: ${scene}, ${method}`, async () => {
            const { steps } = presets[scene];
            await choose(page, scene, method, steps);
            const poke = [];
            if (scene !== "water") {
                // water already has its default poke
                await ask(page, "step", pokeAt);
                const length = { cloth: 2, rope: 2, jelly: 0.7 }[scene];
                const at = await ask(page, "time");
                await ask(page, "poke", ...pokeOf(scene, length));
                poke.push("--poke", [at, ...pokeOf(scene, length)].join(","));
            }
            await ask(page, "step", scene === "water" ? frames : frames - pokeAt);
            const wanted = await native(tool, runOf(scene), method, steps, frames / 60, poke);
            assert.match(wanted, /^[0-9a-f]{16}$/);
            assert.equal(await ask(page, "hash"), wanted);
        });
}
await test("the bits of spring-scene: a scene that runs begins again when it is stepped", async () => {
    await choose(page, "cloth", "rk4");
    await page.click("#pause");
    await until("it runs", async () => (await ask(page, "time")) > 0);
    await ask(page, "step", 30);
    const wanted = await native(tool, runOf("cloth"), "rk4", presets.cloth.steps, 0.5);
    assert.equal(await ask(page, "hash"), wanted);
});
await test("the bits of spring-scene: damped links, a poke while it runs", async () => {
    await choose(page, "jelly", "leapfrog");
    await page.fill("#damping", "3");
    await begin(page);
    await ask(page, "step", 30);
    const poke = ["--poke", [await ask(page, "time"), ...pokeOf("jelly", 0.7)].join(",")];
    await ask(page, "poke", ...pokeOf("jelly", 0.7));
    await ask(page, "step", 30);
    const run = { scene: "jelly", damping: 0.03 };
    const wanted = await native(tool, run, "leapfrog", presets.jelly.steps, 1, poke);
    assert.equal(await ask(page, "hash"), wanted);
});
await test("the command that the page shows, with other settings", async () => {
    await choose(page, "rope", "rk4");
    await page.click("#heavy");
    await page.selectOption("#size", "10");
    await begin(page);
    await ask(page, "step", 20);
    await page.click("summary");
    await page.click("#hash");
    await until("the hash", async () => /^[0-9a-f]{16}$/.test(await page.textContent("#hash-out")));
    await page.click("summary");
    const words = (await page.textContent("#command")).split(" ");
    const value = (name) => Number(words[words.indexOf(name) + 1]);
    const run = { scene: "rope", size: 10, mass: 0.01, endMass: 100, stiffness: 2e5, drag: 0 };
    assert.equal(value("--end-mass"), 100);
    const wanted = await native(tool, run, "rk4", value("--steps-per-frame"), value("--duration"));
    assert.equal(await page.textContent("#hash-out"), wanted);
});

await test("it said nothing on the console, and asked nobody for anything", () =>
    assert.deepEqual(page.complaints, []));
await browser.close();
done();
