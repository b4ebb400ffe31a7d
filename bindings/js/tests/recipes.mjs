// SPDX-License-Identifier: MIT
// The recipes of README and of docs/javascript.md, in Chromium. Prints TAP.
//     recipes.mjs PROJECT README JAVASCRIPT.MD     PROJECT has springstep, react, react-dom, svelte, vue, three, esbuild and
//                                                  playwright-core, and receives the programs
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { done, test } from "./tap.mjs";

const [project, readme, page_] = process.argv.slice(2);
const required = createRequire(join(project, "package.json"));
const { buildSync } = required("esbuild");
const { chromium } = required("playwright-core");

/** The program of a section, the n-th of its kind. */
function program(file, heading, kind, n = 0) {
    const text = readFileSync(file, "utf8");
    const section = text.slice(text.search(new RegExp(`^#+ ${heading}$`, "m"))).replace(/^#.*\n/, "");
    const end = section.search(/^#/m);
    const programs = section
        .slice(0, end < 0 ? undefined : end)
        .split("```")
        .filter((_, i) => i % 2 === 1);
    const found = programs.filter((each) => each.startsWith(`${kind}\n`))[n];
    assert.ok(found, `${heading}: no program`);
    return found.slice(kind.length + 1);
}

/** A page with an element for each id, and a program that may export something to `recipe`. */
async function opened(name, code, { kind = "js", html = "", more = "", policy = "", ...context } = {}) {
    writeFileSync(join(project, `${name}.${kind}`), `${code}\n`);
    writeFileSync(
        join(project, `${name}-page.${kind}`),
        `import * as recipe from "./${name}";\nObject.assign(window, { recipe });\n${more}\n`,
    );
    const { outputFiles } = buildSync({
        absWorkingDir: project,
        entryPoints: [`${name}-page.${kind}`],
        bundle: true,
        write: false,
        format: "iife",
        jsx: "automatic",
        define: { "process.env.NODE_ENV": '"development"' },
        logLevel: "error",
    });
    const opened = await browser.newPage({ ...context, viewport: { width: 800, height: 600 } });
    opened.setDefaultTimeout(30000);
    opened.errors = [];
    opened.on("pageerror", (error) => opened.errors.push(`${error}`));
    opened.on("console", (message) => message.type() === "error" && opened.errors.push(message.text()));
    const files = {
        "/": `<!doctype html><link rel="icon" href="data:,"><style>body { margin: 0 } div { width: 50px; height: 50px }</style>
            <body>${html}<script src="/page.js"></script>`,
        "/page.js": outputFiles[0].text,
        "/scenes.wasm": readFileSync(required.resolve("springstep/scenes.wasm")),
    };
    const types = { "/": "text/html", "/page.js": "text/javascript", "/scenes.wasm": "application/wasm" };
    await opened.route("http://recipe.test/**", (route) => {
        const { pathname } = new URL(route.request().url());
        const headers = { "content-type": types[pathname], "content-security-policy": policy };
        return route.fulfill({ body: files[pathname], headers });
    });
    await opened.goto("http://recipe.test/");
    return opened;
}

/** Moves the pointer from a place, evenly for a number of ms, and lets go after a further time. */
async function flick(page, [x, y], [vx, vy], ms, pause = 0) {
    await page.mouse.move(x, y);
    await page.mouse.down();
    const begin = Date.now();
    for (let t = 0; t < ms; t = Date.now() - begin) await page.mouse.move(x + vx * t, y + vy * t);
    await page.mouse.move(x + vx * ms, y + vy * ms); // a busy machine may have made one move
    if (pause > 0) await page.waitForTimeout(pause);
    await page.mouse.up();
}

/** Dispatches events of touches at places. */
async function fingers(page) {
    const session = await page.context().newCDPSession(page);
    return (type, ...places) => {
        const touchPoints = places.map(([x, y], id) => ({ x, y, id }));
        return session.send("Input.dispatchTouchEvent", { type, touchPoints });
    };
}

const placeOf = (page, selector) =>
    page.evaluate((one) => getComputedStyle(document.querySelector(one)).translate, selector);
const rests = (page, selector, place) =>
    page.waitForFunction(
        ([one, at]) => getComputedStyle(document.querySelector(one)).translate === at,
        [selector, place],
    );

const flags = "--no-sandbox --disable-gpu --enable-unsafe-swiftshader --disable-background-networking".split(
    " ",
);
const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args: flags,
});

await test("50 animations that are started by clicks: no step backwards, each settles and starts again", async () => {
    const [imports, body] = program(readme, "springstep", "js").split("\n\n", 2);
    const rest = program(readme, "springstep", "js").slice(imports.length + body.length + 4);
    const code = `${imports}
        export const springs = [...document.querySelectorAll("div")].map((box) => { ${body}\n${rest}; return x; });
        export const seen = [];
        const { step } = Spring.prototype;
        Spring.prototype.step = function (dt) {
            seen.push(dt);
            return step.call(this, dt);
        };`;
    const html = '<div style="height: 10px"></div>'.repeat(50);
    const page = await opened("loop", code, { html });
    const clickAll = async () => {
        for (let i = 0; i < 50; i++) {
            const place = await page.evaluate(
                (k) => document.querySelectorAll("div")[k].getBoundingClientRect(),
                i,
            );
            await page.mouse.click(place.x + 25, place.y + 5);
        }
    };
    const targets = () => page.evaluate(() => recipe.springs.reduce((sum, x) => sum + x.target, 0));
    const allSettle = () =>
        page.waitForFunction(() => recipe.springs.every((x) => x.settled && x.value === x.target));
    for (const round of [1, 2, 3, 4]) {
        await clickAll();
        assert.equal(await targets(), round % 2 ? 5000 : 0);
        if (round !== 2) await allSettle(); // the third round interrupts the second
    }
    const steps = await page.evaluate(() => recipe.seen);
    assert.ok(steps.length >= 4 * 50 && steps.every((dt) => dt >= 0), `${steps.length} steps`);
    await page.waitForTimeout(100);
    assert.equal(await page.evaluate(() => recipe.seen.length), steps.length, "the loop stops");
    assert.deepEqual(page.errors, []);
    const reduced = await opened("loop", code, { html, reducedMotion: "reduce" });
    await reduced.mouse.click(25, 5);
    await rests(reduced, "div", "100px");
    assert.equal(await reduced.evaluate(() => recipe.seen.length), 0, "it jumps");
});

await test("drag: the element follows the pointer, keeps its velocity, and returns", async () => {
    const more = `
        import { Spring } from "springstep";
        import { animate } from "springstep/animate";
        const box = document.querySelector("#box");
        const [x, y] = [0, 0].map(() => new Spring(0, { duration: 0.4, bounce: 0.3 }));
        const place = () => (box.style.translate = x.value + "px " + y.value + "px");
        animate(x, place);
        animate(y, place);
        recipe.makeDraggable(box, x, y);
        box.addEventListener("pointerup", () => (window.released = [x.value, x.velocity, y.velocity]));
        Object.assign(window, { x, y });`;
    const page = await opened("drag", program(readme, "Drag", "ts"), {
        kind: "ts",
        html: '<div id="box"></div>',
        more,
    });
    const flicks = [];
    const good = ([left, vx, vy]) => left > 50 && vx > 500 && vx < 1500 && vy > 0.4 * vx && vy < 0.6 * vx;
    // A busy machine may hold the pointer still before it lets go.
    while (flicks.length < 5 && !flicks.some(good)) {
        await flick(page, [20, 20], [1, 0.5], 150);
        flicks.push(await page.evaluate(() => window.released));
        await rests(page, "#box", "0px");
    }
    assert.ok(flicks.some(good), JSON.stringify(flicks));
    assert.equal(await page.evaluate(() => x.settled && y.settled), true);
    await page.mouse.move(20, 20);
    await page.mouse.down({ button: "right" });
    await page.mouse.move(80, 20);
    assert.deepEqual(await page.evaluate(() => [x.value, x.settled]), [0, true], "another button");
    await page.mouse.up({ button: "right" });
    await page.waitForFunction(() => x.settled && y.settled);
    await page.evaluate(async () => {
        const dispatch = (type, clientX) =>
            document.querySelector("#box").dispatchEvent(new PointerEvent(type, { pointerId: 1, clientX }));
        dispatch("pointerdown", 20);
        await new Promise((resolve) => setTimeout(resolve, 16));
        dispatch("pointermove", 50);
        dispatch("pointerup", 50);
    });
    const [, speed] = await page.evaluate(() => window.released);
    assert.ok(speed > 0, "a flick with one move has a velocity");
    await page.waitForFunction(() => x.settled && y.settled);
    const touches = await fingers(page);
    await touches("touchStart", [20, 20]);
    await touches("touchMove", [60, 30]);
    await page.waitForFunction(() => x.value === 40 && y.value === 10);
    await touches("touchStart", [60, 30], [80, 40]);
    await touches("touchMove", [60, 30], [90, 70]);
    await page.waitForTimeout(50);
    assert.deepEqual(await page.evaluate(() => [x.value, y.value]), [40, 10], "another finger");
    await touches("touchEnd");
    await page.waitForFunction(() => x.settled && y.settled);
    assert.deepEqual(page.errors, []);
});

await test("slots: a flick carries the element to another slot, and the page is told when it rests", async () => {
    const html = '<div id="box"></div>';
    const more = `
        window.rested = [];
        const slots = [[0, 0], [300, 20]];
        window.end = recipe.dragToSlots(document.querySelector("#box"), slots, (slot) => rested.push(slot));`;
    const page = await opened("slots", program(page_, "Slots", "js"), { html, more });
    await flick(page, [20, 20], [0, 0], 50);
    await page.waitForFunction(() => rested.length === 1);
    await page.mouse.down();
    await page.mouse.move(260, 20, { steps: 5 });
    await page.mouse.up();
    await page.waitForFunction(() => rested.length === 2);
    await flick(page, [320, 40], [0.1, 0], 100);
    await page.waitForFunction(() => rested.length === 3);
    assert.equal(await placeOf(page, "#box"), "300px 20px");
    const slots = [[0, 0], ...Array(2).fill([300, 20])];
    assert.deepEqual(await page.evaluate(() => rested), slots);
    await page.evaluate(() => end());
    await flick(page, [320, 40], [1, 0], 100);
    await page.waitForTimeout(50);
    assert.equal(await placeOf(page, "#box"), "300px 20px", "it has ended");
    assert.deepEqual(page.errors, []);
});

await test("React: in StrictMode, on a server, and after it is unmounted", async () => {
    const code = program(readme, "React", "tsx"); // drag.ts is from the test before
    const more = `
        import { StrictMode } from "react";
        import { createRoot } from "react-dom/client";
        import { renderToString } from "react-dom/server";
        window.server = renderToString(<recipe.Card />);
        const root = createRoot(document.querySelector("#root")!);
        root.render(<StrictMode><recipe.Card /></StrictMode>);
        const left = () => parseFloat(getComputedStyle(document.querySelector(".card")!).translate) || 0;
        const timer = setInterval(() => (window.most = Math.max(window.most ?? 0, left())), 5);
        Object.assign(window, { unmount: () => (clearInterval(timer), root.unmount()) });`;
    const page = await opened("react", code, { kind: "tsx", html: '<main id="root"></main>', more });
    await page.waitForSelector(".card");
    assert.match(await page.evaluate(() => window.server), /class="card"/);
    await flick(page, [20, 20], [1, 0], 120);
    await rests(page, ".card", "0px");
    assert.ok((await page.evaluate(() => window.most)) > 50, "it follows the pointer");
    await flick(page, [20, 20], [1, 0], 50);
    await page.evaluate(() => window.unmount());
    await page.waitForTimeout(100);
    assert.deepEqual(page.errors, []);
});

await test("React: a property moves a spring", async () => {
    const code = program(readme, "React", "tsx");
    const more = `
        import { StrictMode } from "react";
        import { createRoot } from "react-dom/client";
        const root = createRoot(document.querySelector("#root")!);
        window.show = (open) => root.render(<StrictMode><recipe.Drawer open={open} /></StrictMode>);
        window.show(false);`;
    const page = await opened("drawer", code, { kind: "tsx", html: '<main id="root"></main>', more });
    await rests(page, ".drawer", "-200px");
    await page.evaluate(() => show(true));
    await page.waitForFunction(
        () => parseFloat(getComputedStyle(document.querySelector(".drawer")).translate) > -150,
    );
    await page.evaluate(() => show(false));
    await rests(page, ".drawer", "-200px");
    await page.evaluate(() => show(true));
    await rests(page, ".drawer", "0px");
    assert.deepEqual(page.errors, []);
});

await test("Svelte: a store", async () => {
    const more = `
        const store = recipe.springStore(0, { duration: 0.2 });
        window.seen = [];
        window.stop = store.subscribe((value) => seen.push(value));
        store.set(5);
        window.store = store;`;
    const page = await opened("svelte", program(page_, "Svelte", "js"), { more });
    await page.waitForFunction(() => window.seen.at(-1) === 5);
    assert.ok((await page.evaluate(() => seen.length)) > 2, "it moves through values between");
    await page.evaluate(() => (stop(), store.set(9)));
    await page.waitForTimeout(100);
    assert.equal(await page.evaluate(() => seen.at(-1)), 5, "nobody subscribes");
    await page.evaluate(() => store.subscribe((value) => seen.push(value)));
    await page.waitForFunction(() => window.seen.at(-1) === 9);
    assert.deepEqual(page.errors, []);
});

await test("Vue: a ref", async () => {
    const more = `
        import { createApp, h } from "vue";
        const app = createApp({
            setup() {
                const { spring, value } = recipe.useSpring(0, { duration: 0.2 });
                window.spring = spring;
                return () => h("p", value.value);
            },
        });
        app.mount("#root");
        window.app = app;`;
    const page = await opened("vue", program(page_, "Vue", "js"), { html: '<main id="root"></main>', more });
    await page.evaluate(() => (spring.target = 5));
    await page.waitForFunction(() => document.querySelector("p").textContent === "5");
    await page.evaluate(() => (app.unmount(), (spring.target = 7)));
    await page.waitForTimeout(100);
    assert.equal(await page.evaluate(() => spring.value), 5, "it is unmounted");
    assert.deepEqual(page.errors, []);
});

await test("a list of 50", async () => {
    const html = Array.from(
        { length: 50 },
        (_, i) => `<div id="i${i}" style="position: absolute"></div>`,
    ).join("");
    const more = 'window.sort = recipe.sortable([...document.querySelectorAll("div")], 40).sort;';
    const page = await opened("list", program(page_, "A list", "js"), { html, more });
    await rests(page, "#i49", "0px 1960px");
    await page.evaluate(() => sort(Array.from({ length: 50 }, (_, i) => 49 - i)));
    await rests(page, "#i49", "0px");
    await rests(page, "#i0", "0px 1960px");
    assert.deepEqual(page.errors, []);
});

await test("a list whose items are dragged, also while it is sorted", async () => {
    const html = '<div id="a" style="position: absolute"></div><div id="b" style="position: absolute"></div>';
    const more = `
        const items = [...document.querySelectorAll("div")];
        const list = (window.list = recipe.sortable(items, 100));
        recipe.draggableItems(items, list);
        const released = () => (window.released = [...list.y.value, ...list.y.velocity]);
        items[1].addEventListener("pointerup", released);`;
    const code = program(page_, "A list", "js") + program(page_, "A list", "js", 1);
    const page = await opened("dragged", code, { html, more });
    await rests(page, "#b", "0px 100px");
    await flick(page, [20, 120], [0, 0.5], 150);
    const [first, second, still, speed] = await page.evaluate(() => window.released);
    assert.ok(first === 0 && still === 0 && second > 110 && speed >= 0, `${[first, second, still, speed]}`);
    await rests(page, "#b", "0px 100px");
    assert.equal(await placeOf(page, "#a"), "0px");
    await page.mouse.move(20, 120);
    await page.mouse.down();
    await page.mouse.move(20, 160);
    await page.evaluate(() => list.sort([1, 0]));
    await rests(page, "#a", "0px 100px");
    const [, held] = (await placeOf(page, "#b")).split(" ");
    assert.ok(Math.abs(parseFloat(held) - 140) < 1, `a dragged item stays at the pointer: ${held}`); // may still settle
    await page.mouse.up();
    await rests(page, "#b", "0px");
    await page.evaluate(() => {
        list.stop();
        list.sort([0, 1]);
    });
    await page.waitForTimeout(100);
    assert.equal(await placeOf(page, "#b"), "0px", "a stopped animation");
    assert.deepEqual(page.errors, []);
});

await test("a staggered list: items start one after the other", async () => {
    const html = Array.from({ length: 9 }, (_, i) => `<div id="i${i}"></div>`).join("");
    const more = `
        window.order = [];
        window.items = [...document.querySelectorAll("div")];
        recipe.slideIn(items, 80);
        const left = (item) => parseFloat(getComputedStyle(item).translate);
        requestAnimationFrame(function look() {
            const moves = items.map((item, i) => [i, left(item) > -200]).filter(([i, on]) => on && !order.includes(i));
            order.push(...moves.map(([i]) => i));
            if (order.length < 9) requestAnimationFrame(look);
        });`;
    const page = await opened("staggered", program(page_, "A staggered list", "js"), { html, more });
    await rests(page, "#i8", "0px");
    await rests(page, "#i0", "0px");
    assert.deepEqual(await page.evaluate(() => order), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    assert.deepEqual(page.errors, []);
});

await test("a CSS transition moves like the spring", async () => {
    const html = '<div id="box" style="translate: 0px"></div>';
    const more = `
        import { Spring } from "springstep";
        const options = { duration: 0.5, bounce: 0.3 };
        const box = document.querySelector("#box");
        recipe.springTransition(box, "translate", options);
        getComputedStyle(box).translate;
        box.style.translate = "100px";
        const [transition] = box.getAnimations();
        transition?.pause();
        window.errors = Array.from({ length: 50 }, (_, i) => {
            const spring = new Spring(0, options);
            spring.target = 100;
            if (transition) transition.currentTime = 20 * i;
            return Math.abs(spring.step(i / 50) - parseFloat(getComputedStyle(box).translate));
        });`;
    const code = program(page_, "A CSS transition", "js");
    const page = await opened("transition", code, { html, more });
    const errors = await page.evaluate(() => window.errors);
    assert.ok(Math.max(...errors) < 0.2, `${errors}`);
    assert.deepEqual(page.errors, []);
    const reduced = await opened("transition", code, { html, more, reducedMotion: "reduce" });
    assert.equal(await placeOf(reduced, "#box"), "100px", "it jumps");
});

await test("a sheet: a flick dismisses it, a slow drag does not", async () => {
    const html = '<div id="sheet" style="position: absolute; top: 300px; width: 300px; height: 200px"></div>';
    const more = `recipe.sheet(document.querySelector("#sheet"), () => (window.dismissed = true));
        window.least = 0;
        const low = () => (window.least = Math.min(window.least, parseFloat(sheet.style.translate.split(" ")[1] ?? 0)));
        new MutationObserver(low).observe(sheet, { attributes: true });`;
    const page = await opened("sheet", program(page_, "A sheet", "js"), { html, more });
    await flick(page, [100, 320], [0, 0.1], 200, 200);
    await rests(page, "#sheet", "0px");
    assert.equal(await page.evaluate(() => window.dismissed), undefined);
    await flick(page, [100, 450], [0, -1.5], 60);
    await rests(page, "#sheet", "0px");
    assert.equal(await page.evaluate(() => window.least), 0, "it does not rise above its open position");
    for (let i = 0; i < 5 && !(await page.evaluate(() => window.dismissed)); i++) {
        await flick(page, [100, 320], [0, 1.2], 60);
        await page.waitForFunction(() => ["0px", "0px 200px"].includes(getComputedStyle(sheet).translate));
    }
    assert.equal(await page.evaluate(() => window.dismissed), true);
    assert.equal(await placeOf(page, "#sheet"), "0px 200px");
    assert.deepEqual(page.errors, []);
});

await test("a canvas: the rope hangs from the pointer", async () => {
    const html = '<canvas width="400" height="400"></canvas>';
    const more = 'window.rope = recipe.hangRope(document.querySelector("canvas"));';
    const page = await opened("canvas", program(page_, "A canvas", "js"), { html, more });
    await page.mouse.move(100, 60);
    await page.waitForFunction(
        () => Math.abs(rope.positions[0] - 100) < 1 && Math.abs(rope.positions[1] - 60) < 1,
    );
    const hangs = () => Math.hypot(...[0, 1].map((k) => rope.positions[87 + k] - rope.positions[k])) < 260;
    await page.waitForFunction(hangs);
    assert.deepEqual(page.errors, []);
});

await test("CSS: an easing that Chromium accepts", async () => {
    const code = `const box = document.querySelector("#box");\n${program(readme, "CSS", "js")}`;
    const page = await opened("css", code, { html: '<div id="box"></div>' });
    await rests(page, "#box", "100px");
    assert.deepEqual(page.errors, []);
});

await test("three.js: cloth", async () => {
    const before = `
        import * as THREE from "three";
        const geometry = new THREE.BufferGeometry();
        const [world, camera] = [new THREE.Scene(), new THREE.PerspectiveCamera(60, 1, 0.1, 10)];
        camera.position.set(1.2, 1, 3);
        world.add(new THREE.Mesh(geometry, new THREE.MeshNormalMaterial({ side: THREE.DoubleSide })));
        const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
        renderer.setSize(200, 200);
        document.body.append(renderer.domElement);`;
    const code = `${before}\n${program(readme, "Scenes", "js")}\nexport { cloth, renderer };`;
    const page = await opened("three", code);
    assert.deepEqual(page.errors, []);
    await page.waitForFunction(() => recipe.cloth.time > 0.2);
    const covered = await page.evaluate(() => {
        const gl = recipe.renderer.getContext();
        const pixels = new Uint8Array(4 * 200 * 200);
        gl.readPixels(0, 0, 200, 200, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
        return pixels.filter((value, i) => i % 4 === 3 && value > 0).length;
    });
    assert.ok(covered > 4000, `${covered} pixels`);
    assert.deepEqual(page.errors, []);
});

await test("scenes by file, under a content security policy", async () => {
    const [head] = program(readme, "Scenes", "js", 1).split('import wasm from "springstep/scenes.wasm?url";');
    const code = `${head}
        export const time = ready(fetch("/scenes.wasm")).then(() => {
            const rope = new Scene(grid({ count: [3], spacing: 1, stiffness: 1 }));
            return rope.frame(0.1), rope.time;
        });`;
    const script = "script-src 'self'";
    const page = await opened("bare", code, { policy: `${script} 'wasm-unsafe-eval'` });
    assert.ok((await page.evaluate(() => recipe.time)) > 0);
    const strict = await opened("bare", code, { policy: script });
    await assert.rejects(
        strict.evaluate(() => recipe.time),
        /wasm-unsafe-eval|Content Security Policy/,
    );
});

await browser.close();
done();
