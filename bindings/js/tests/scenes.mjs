// SPDX-License-Identifier: MIT
// Scenes: the bits of spring-scene; what a scene offers; errors; memory.
//     node scenes.mjs SPRING-SCENE
import assert from "node:assert/strict";
import { execFile, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { hashOf, preset, Pushes, readPresets, takeSteps } from "../../../tools/scenes/presets.mjs";
import { chance, logarithmic, uniform } from "./random.mjs";
import { done, note, refused, test } from "./tap.mjs";

const [program] = process.argv.slice(2);
let compiled = 0;
for (const name of ["Module", "instantiate"]) {
    const plain = WebAssembly[name];
    WebAssembly[name] = function (...values) {
        compiled++;
        return new.target ? new plain(...values) : plain(...values);
    };
}
const {
    bendGrid,
    bendMesh,
    bendRod,
    components,
    fromMesh,
    grid,
    hasSimd,
    methods: offered,
} = await import("../scenes.js");
const { ready, Scene, soften, TENSION_ONLY, TETHER, tethers } = await import("../scenes.js");
const { borrowed, library, memory } = await import("../module.js");
const { lendColliders } = await import("../definition.js");
const methods = ["euler", "symplectic-euler", "leapfrog", "rk4", "rkn8", "srkn6"];

function offers(definition, method) {
    try {
        new Scene({ ...definition, methods: [method] }).free();
        return true;
    } catch (error) {
        assert.equal(error.name, "TypeError");
        return false;
    }
}

function native(words) {
    return new Promise((resolve, reject) =>
        execFile(program, words, (error, out, complaint) => {
            if (error && error.code !== 1) reject(new Error(complaint));
            else resolve(out.trim());
        }),
    );
}

/** A rope of n links in a plane, held at one end. */
function rope(more = {}) {
    return new Scene({
        ...grid({ count: [5], axes: 2, spacing: 0.5, stiffness: 300, damping: 0.2, pinned: ["firstX"] }),
        mass: 0.1,
        gravity: [0, -9.81],
        ...more,
    });
}

await test("an import compiles nothing, the first use does, ready() once more does not", async () => {
    assert.equal(compiled, 0);
    assert.equal(hasSimd(), true);
    rope().free();
    assert.equal(compiled, 1);
    await ready();
    assert.equal(compiled, 1);
});
await test("in an engine without SIMD the first use of a scene tells what is needed, and springs work", () => {
    const [scenes, springs] = ["scenes.js", "index.js"].map((file) =>
        JSON.stringify(new URL(`../${file}`, import.meta.url)),
    );
    const needed = /Error: springstep\/scenes needs SIMD for WebAssembly: .*Node 18 or later/;
    for (const [without, prints, fails] of [
        ["", "spring scenes used ", undefined],
        ["WebAssembly.validate = () => false", "spring scenes ", needed],
        ["delete globalThis.WebAssembly", "spring scenes ", needed],
    ]) {
        const program = `${without};
            const say = (text) => process.stdout.write(text + " ");
            import(${springs}).then(({ Spring }) => say(new Spring(0).step(1) || "spring"))
                .then(() => import(${scenes})).then(({ Scene }) => say("scenes") && new Scene({ position: [0, 0, 0] }))
                .then(() => say("used"));`;
        const { stdout, stderr } = spawnSync(process.execPath, ["--eval", program], { encoding: "utf8" });
        assert.equal(stdout, prints);
        if (fails) assert.match(stderr, fails);
    }
});

await test("the module by file: a response, bytes, a compiled module", () => {
    const local = (name) => JSON.stringify(new URL(`../${name}`, import.meta.url));
    const bytes = `readFileSync(new URL(${local("scenes.wasm")}))`;
    for (const [module, prints] of [
        ["", "springstep/scenes/bare: first await ready() with scenes.wasm"],
        [`await ready(Promise.resolve(new Response(${bytes})))`, "2"],
        [`await ready(${bytes})`, "2"],
        [`await ready(new WebAssembly.Module(${bytes})); await ready()`, "2"],
        [
            'await ready(new Response("", { status: 404, statusText: "Not Found" }))',
            "scenes.wasm: 404 Not Found",
        ],
        ["await ready()", "springstep/scenes/bare: first await ready() with scenes.wasm"],
    ]) {
        const program = `import { readFileSync } from "node:fs";
            import { grid, ready } from ${local("bare.js")};
            try { ${module}; console.log(grid({ count: [2], spacing: 1, stiffness: 1 }).position.length / 3); }
            catch (error) { console.log(error.message); }`;
        const how = ["--input-type=module", "--eval", program];
        const { stdout, stderr } = spawnSync(process.execPath, how, { encoding: "utf8" });
        assert.equal(stdout + stderr, `${prints}\n`, module);
    }
});

await test("triangles of grids: areas, orientation, texture coordinates", () => {
    for (const [count, area] of [
        [[4, 3], 3 * 2],
        [[3, 4, 5], 2 * (2 * 3 + 2 * 4 + 3 * 4)],
        [[5], 0],
    ]) {
        const scene = new Scene(grid({ count, spacing: 1, stiffness: 1 }));
        const { positions: p } = scene;
        const triangles = scene.triangles();
        const all = [0, 0, 0]; // sum of normals times area
        let sum = 0;
        let volume = 0;
        for (let i = 0; i < triangles.length; i += 3) {
            const [a, b, c] = [...triangles.subarray(i, i + 3)].map((k) => [...p.subarray(3 * k, 3 * k + 3)]);
            const [u, v] = [b, c].map((q) => q.map((x, k) => x - a[k]));
            const normal = [0, 1, 2].map(
                (k) => (u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]) / 2,
            );
            normal.forEach((x, k) => (all[k] += x));
            sum += Math.hypot(...normal);
            volume += normal.reduce((dot, x, k) => dot + x * a[k], 0) / 3;
        }
        assert.ok(Math.abs(sum - area) < 1e-9, `${count}: ${sum}`);
        if (count.length === 2) assert.deepEqual(all, [0, 0, area]);
        if (count.length === 3) assert.ok(Math.abs(volume - 2 * 3 * 4) < 1e-9, "outwards");
        const uv = scene.textureCoordinates();
        for (let k = 0; k < scene.particles; k++)
            for (const axis of [0, 1]) {
                const width = (count[axis] ?? 1) - 1;
                assert.ok(Math.abs(uv[2 * k + axis] * width - (width && p[3 * k + axis])) < 1e-6);
            }
    }
    refused(
        () => new Scene({ position: [0, 0, 0] }).triangles(),
        "TypeError: the scene is defined without the count of a grid",
    );
    for (const [count, wanted] of [
        [[2, 1, 1], "count must be that of all particles, got [2,1,1]"],
        [[1.5, 2, 1], "count[0] must be an integer >= 1, got 1.5"],
        [[3, -1, -1], "count[1] must be an integer >= 1, got -1"],
    ])
        refused(
            () => new Scene({ ...grid({ count: [3], spacing: 1, stiffness: 1 }), count }),
            `RangeError: ${wanted}`,
        );
});

await test("frame(elapsed) has defaults for method and step", () => {
    const sheet = grid({ count: [9, 9], spacing: 0.1, stiffness: 400, pinned: ["lastY"] });
    const definition = { ...sheet, mass: 0.01, gravity: [0, -9.81, 0] };
    for (const tensionOnly of [false, true]) {
        const [a, b] = [1, 2].map(() => new Scene({ ...definition, tensionOnly }));
        const dt = 1 / 60 / Math.ceil((tensionOnly ? 4 : 2) / 60 / a.stableStep());
        for (let i = 0; i < 30; i++) assert.equal(a.frame(1 / 50), b.frame("leapfrog", dt, 1 / 50));
        assert.deepEqual(a.positions, b.positions);
    }
    const a = new Scene(definition);
    assert.equal(a.frame(-1), 0);
    assert.equal(a.frame(0.1, { dt: 0.001, mostSteps: 5 }), 5);
    let moved = 0;
    assert.equal(a.frame(0.01, { method: "symplectic-euler", dt: 0.001, move: () => moved++ }), 10);
    assert.equal(moved, 1);
    assert.equal(new Scene({ position: [0, 0, 0] }).frame(1 / 60 + 1e-9), 4, "steps of 1/240 s");
    refused(() => a.frame(0.1, { steps: 3 }), "TypeError: the option steps is unknown");
    refused(() => a.frame(NaN), "RangeError: elapsed must be a finite number, got NaN");
});

const steps = { rope: 7, cloth: 19, jelly: 9, chain: 5, water: 13 };
const presets = readFileSync(new URL("../../../tools/scenes/presets.c", import.meta.url), "utf8");
const usual = readPresets(presets).flatMap((scene) => methods.map((method) => [{ scene }, method]));
const further = [
    [{ scene: "rope", mass: 0.01, endMass: 100, stiffness: 2e5, drag: 0 }, "leapfrog"],
    [{ scene: "cloth", size: 12, damping: 0.01, drag: 0.02 }, "leapfrog"],
    [{ scene: "cloth", size: 12, damping: 3 }, "leapfrog"],
    [{ scene: "jelly", damping: 0.03 }, "rk4"],
    [{ scene: "water", size: 40, drag: 2 }, "srkn6"],
];
let compared = 0;
for (const [settings, method] of [...usual, ...further]) {
    const made = preset(grid, settings);
    const { scene: name, endMass } = settings;
    if (!offers(made.definition, method)) continue;
    compared++;
    await test(`the hash of spring-scene: ${Object.values(settings).join(" ")}, ${method}`, async () => {
        const n = endMass ? 150 : steps[name];
        const words = `--scene ${name} --method ${method} --steps-per-frame ${n} --duration 2 --hash`.split(
            " ",
        );
        for (const [key, value] of Object.entries(settings))
            if (key !== "scene") words.push(key === "endMass" ? "--end-mass" : `--${key}`, value);
        const { start, settings: all } = made;
        const [at, x, y, area] = [0.3, 0.4 * all.length, start.at(-2) * 0.3, all.length ** 2 / 20];
        const peak = name === "water" ? 5e4 : 2;
        const pushes = new Pushes(made);
        if (name === "chain") {
            const scene = new Scene({ ...made.definition, methods: [method] });
            takeSteps(scene, method, 1 / (60 * n), 120 * n);
            assert.equal(hashOf(scene), await native(words));
            return scene.free();
        }
        words.push("--poke", [at, x, y, peak, area].join());
        pushes.add({ start: at, x, y, peak, area });
        const scene = new Scene({ ...made.definition, methods: [method, "leapfrog"], force: pushes.force });
        for (let frame = 0; frame < 120; frame++) if (takeSteps(scene, method, 1 / (60 * n), n) < n) break;
        assert.equal(hashOf(scene), await native(words));
        scene.free();
    });
}
note(`${compared} scenes and methods`);

/** Random edits, tears, contacts and forces of a rope. */
function eventful() {
    const push = (t, x, [fx]) => fx.forEach((_, i) => (fx[i] += Math.sin(7 * t) - 0.1 * x[0][i]));
    const options = {
        editable: chance(0.5),
        heldForces: chance(0.5),
        tensionOnly: chance(0.3),
        noUndo: chance(0.3),
        colliders: chance(0.5) ? 2 : 0,
        force: chance(0.3) ? push : null,
        forceUsesVelocity: chance(0.5),
    };
    const floor = { shape: "plane", at: [0, -0.3], velocity: [0, 0.1], friction: 0.4 };
    const live = (scene) => {
        scene.advance("leapfrog", 1e-3, 30);
        if (options.editable) scene.tear(1.05);
        if (options.editable) scene.pin(3);
        if (options.heldForces) scene.set("force", [0.1, 0.2], 2);
        if (options.colliders) scene.setColliders([floor]);
        scene.setGravity([0, -3]);
        scene.advance("leapfrog", 1.5e-3, 40);
    };
    return [rope(options), rope(options), live];
}

await test("a saved state goes on alike in another scene of the same definition", () => {
    for (let run = 0; run < 60; run++) {
        const [scene, other, live] = eventful();
        live(scene);
        const state = scene.save();
        assert.ok(state instanceof Uint8Array);
        if (chance(0.5)) live(other);
        other.frame("leapfrog", 1e-3, 0.0155);
        other.load(state);
        assert.deepEqual(other.save(), state);
        assert.equal(other.time, scene.time);
        assert.deepEqual(other.positions, scene.positions);
        for (const each of [scene, other]) {
            each.advance("leapfrog", 1.5e-3, 100);
            assert.equal(each.frame("leapfrog", 1e-3, 0.0105), 10, "frames start anew");
        }
        assert.deepEqual(other.save(), scene.save());
        scene.free();
        other.free();
    }
});

await test("states that are damaged or of other scenes are refused, and change nothing", () => {
    const scene = rope();
    scene.advance("leapfrog", 1e-3, 10);
    const state = scene.save();
    assert.equal(
        new Uint32Array(state.buffer)[8],
        0,
        "without a force, no flag of forces: C has none either",
    );
    const damaged = state.slice();
    damaged[210] ^= 4;
    const refuse = (what, ...states) => {
        for (const wrong of states)
            assert.throws(
                () => scene.load(wrong),
                (error) => what.test(String(error)),
            );
    };
    refuse(
        /RangeError: state must be an undamaged state, got "?\d+ bytes/,
        ...[damaged, state.slice(1), state.slice(0, -8), new Uint8Array(0)],
    );
    const two = { a: 0, b: 4, rest: 2, stiffness: 300 };
    for (const [more, other] of [
        [{ editable: true }, "flags"],
        [{ heldForces: true, methods: ["leapfrog"] }, "flags, methods"],
        [{ force: () => {} }, "flags, force"],
        [{ axes: 1, gravity: [0], position: [0, 1, 2, 3, 4] }, "axes"],
        [{ links: [two] }, "links, ends or arrays of particles"],
        [{ links: { ...scene.getLinks(), ends: [0, 1, 1, 2, 2, 3, 1, 4] } }, "ends or arrays of particles"],
        [{ colliders: 3 }, "colliders"],
        [{ links: { ...scene.getLinks(), damping: 0 } }, "damping"],
    ])
        refuse(
            new RegExp(
                `state must be the state of a scene with this definition, not with other ${other}, got`,
            ),
            rope(more).save(),
        );
    assert.throws(() => rope({ colliders: 1 }).load(state), RangeError);
    const smooth = { colliders: 1, particleFriction: [0, 0, 0, 0, 0] };
    assert.throws(
        () => rope({ colliders: 1 }).load(rope(smooth).save()),
        /other ends or arrays of particles,/,
    );
    for (const wrong of [null, "text", [...state], new Float64Array(4)])
        assert.throws(() => scene.load(wrong), TypeError);
    assert.deepEqual(scene.save(), state);
    scene.free();
});

await test("two scenes that have run differently run alike after setTime() and set()", () => {
    const [a, b] = [rope(), rope()];
    b.advance("leapfrog", 2e-3, 33);
    for (const each of [a, b]) {
        each.setTime(3);
        each.set("position", new Float64Array(10).fill(0.3));
        each.set("velocity", new Float64Array(10));
        each.advance("leapfrog", 1e-3, 1000);
    }
    assert.equal(a.time, 4);
    assert.deepEqual(a.save(), b.save());
    refused(() => a.setTime(NaN), "RangeError: t must be a finite number, got NaN");
    a.free();
    b.free();
});

for (const name of ["rope", "cloth", "jelly", "water"])
    await test(`states travel from spring-scene and to it: ${name}`, async () => {
        const made = preset(grid, { scene: name });
        const n = steps[name];
        const pushes = new Pushes(made);
        const { start, settings } = made;
        const push = [0.29, 0.4 * settings.length, start.at(-2) * 0.3, 2, settings.length ** 2 / 20];
        pushes.add({ start: push[0], x: push[1], y: push[2], peak: push[3], area: push[4] });
        const folder = mkdtempSync(join(tmpdir(), "springstep-"));
        const run = (...words) =>
            native([
                ...`--scene ${name} --method leapfrog --steps-per-frame ${n} --hash --poke ${push}`.split(
                    " ",
                ),
                ...words,
            ]);
        const [first, second] = ["first", "second"].map((file) => join(folder, file));
        const scene = new Scene({ ...made.definition, methods: ["leapfrog"], force: pushes.force });
        await run("--duration", "0.3", "--save", first);
        scene.load(readFileSync(first));
        for (let frame = 0; frame < 30; frame++) takeSteps(scene, "leapfrog", 1 / (60 * n), n);
        await run("--duration", "0.8", "--save", second);
        assert.deepEqual(scene.save(), new Uint8Array(readFileSync(second)), "every byte");
        writeFileSync(first, scene.save());
        const hash = await run("--load", first, "--duration", "0.2");
        for (let frame = 0; frame < 12; frame++) takeSteps(scene, "leapfrog", 1 / (60 * n), n);
        assert.equal(hash, hashOf(scene));
        scene.free();
        rmSync(folder, { recursive: true });
    });

await test("methods have an order and a number of force evaluations", () => {
    assert.deepEqual(
        offered()
            .map(({ name }) => name)
            .sort(),
        [...methods].sort(),
    );
    const { order, forcesPerStep } = offered().find(({ name }) => name === "rk4");
    assert.deepEqual([order, forcesPerStep], [4, 4]);
});

await test("positions are one array, refilled, also when memory grows", () => {
    const scene = rope();
    const { positions } = scene;
    const before = positions.slice();
    const large = new Scene({ ...grid({ count: [300, 300], spacing: 0.1, stiffness: 1 }) });
    scene.advance("leapfrog", 1e-3, 100);
    assert.equal(scene.positions, positions);
    assert.notDeepEqual(positions, before);
    const exact = scene.get("position");
    for (let i = 0; i < scene.particles; i++)
        assert.deepEqual(
            [...positions.slice(3 * i, 3 * i + 3)],
            [Math.fround(exact[2 * i]), Math.fround(exact[2 * i + 1]), 0],
        );
    large.free();
    scene.free();
});

await test("advance(n) is n times advance(1); frames take the same steps and interpolate", () => {
    const [a, b, c] = [rope(), rope(), rope()];
    a.advance("leapfrog", 1e-3, 100);
    for (let i = 0; i < 100; i++) b.advance("leapfrog", 1e-3);
    assert.equal(hashOf(a), hashOf(b));
    let taken = 0;
    for (let i = 0; i < 67; i++) taken += c.frame("leapfrog", 1e-3, 0.0015);
    assert.equal(taken, 100);
    assert.equal(hashOf(a), hashOf(c));
    const now = Float64Array.from(c.get("position"));
    c.frame("leapfrog", 1e-3, 0.0005); // the next step, of which nothing has passed yet
    c.frame("leapfrog", 1e-3, 0.00025);
    const next = c.get("position");
    const middle = c.positions[3 * 4 + 1];
    assert.ok(Math.abs(middle - (0.75 * now[9] + 0.25 * next[9])) < 1e-7, `${middle} ${now[9]} ${next[9]}`);
    assert.equal(c.frame("leapfrog", 1e-3, 10), 250, "what is beyond 0.25 s is dropped");
    assert.equal(c.frame("leapfrog", 1e-3, 10, 20), 20);
    for (const scene of [a, b, c]) scene.free();
});

await test("negative frame times count as 0, long ones are limited", () => {
    const [a, b] = [rope(), rope()];
    for (let i = 0; i < 50; i++) {
        const elapsed = logarithmic(1e-4, 1e3);
        assert.equal(a.frame("leapfrog", 1e-3, elapsed, 40), b.frame("leapfrog", 1e-3, elapsed, 40));
        assert.equal(a.frame("leapfrog", 1e-3, chance(0.5) ? -elapsed : -0), 0);
        assert.deepEqual(a.positions, b.positions);
    }
    assert.equal(a.frame("leapfrog", 1e-3, Number.MAX_VALUE), 250);
    a.free();
    b.free();
});

await test("a frame that fails changes nothing", () => {
    const scene = rope({ maxSpeed: 1 });
    for (let i = 0; i < 5; i++) scene.frame("leapfrog", 1e-3, 0.01);
    const hash = hashOf(scene);
    assert.throws(() => scene.frame("leapfrog", 1e-3, 0.2), {
        code: "SPRING_EUNSTABLE",
        message: /maxSpeed.*; dt is 0.001/,
    });
    assert.equal(hashOf(scene), hash);
    assert.equal(scene.frame("leapfrog", 1e-3, 0.001), 1);
    scene.free();
});

await test("a frame calls move() once before its steps, and undoes what it did if the frame fails", () => {
    const scene = rope({ editable: true });
    const seen = [];
    const move = (...times) => seen.push(times);
    for (const elapsed of [0.0005, 0.0006, 0.5, 0.0101])
        scene.frame("leapfrog", 1e-3, elapsed, { mostSteps: 20, move });
    const wanted = [
        [0.0011, 0],
        [0.0201, 0.48],
        [0.0102, 0],
    ];
    assert.equal(seen.length, 3, "not without steps");
    seen.flat().forEach((time, i) => assert.ok(Math.abs(time - wanted.flat()[i]) < 1e-12, `${time}`));
    const before = [hashOf(scene), ...scene.get("velocity"), ...scene.positions];
    const fails = () => {
        scene.pin(4);
        scene.transform([1, 0, 0, 9, 0, 1, 0, 0, 0, 0, 1, 0]);
        scene.force = () => {};
        assert.throws(() => scene.free(), TypeError);
        scene.frame("leapfrog", 1e-3, 0.01);
    };
    assert.throws(() => scene.frame("leapfrog", 1e-3, 0.25, { move: fails }), /must not call frame/);
    assert.equal(scene.force, null);
    assert.deepEqual([hashOf(scene), ...scene.get("velocity"), ...scene.positions], before);
    scene.frame("leapfrog", 1e-3, 0.01, { move });
    assert.ok(Math.abs(seen[3][1] - 0.25) < 1e-12, "the time of a frame that failed is dropped");
    scene.free();
});

/** The first program of README with a declaration. */
async function programOfReadme(declaration, name) {
    const text = readFileSync(new URL("../README.md", import.meta.url), "utf8");
    const block = text.split("```").find((each) => each.startsWith(`js\n${declaration}`));
    return (
        await import(`data:text/javascript,${encodeURIComponent(`${block.slice(3)}export { ${name} };`)}`)
    )[name];
}
const withHand = await programOfReadme("function frame(rope,", "frame");
const speed = 10; // [m/s] of the hand

/** A rope of 20 particles that hangs in equilibrium from a hand, and moves with it. */
function hanging(more = {}) {
    const [count, spacing, stiffness, mass] = [20, 0.1, 400, 0.05];
    const links = Array.from({ length: count - 1 }, (_, i) => ({
        a: i,
        b: i + 1,
        rest: spacing - (mass * 9.81 * (count - 1 - i)) / stiffness,
        stiffness,
    }));
    const position = Array.from({ length: 3 * count }, (_, i) =>
        i % 3 === 1 ? (-spacing * (i - 1)) / 3 : 0,
    );
    const velocity = Array.from(position, (_, i) => (i % 3 === 0 ? speed : 0));
    const pinned = [1, ...Array(count - 1).fill(0)];
    return new Scene({ position, velocity, links, mass, pinned, gravity: [0, -9.81, 0], ...more });
}

function longest(scene) {
    const x = scene.get("position");
    let most = 0;
    for (let i = 3; i < x.length; i += 3)
        most = Math.max(most, Math.hypot(x[i] - x[i - 3], x[i + 1] - x[i - 2], x[i + 2] - x[i - 1]) / 0.1);
    return most;
}

await test("the program of README: the free end keeps its place below a hand that moves at 10 m/s", () => {
    for (const noise of [0, 0.5e-3])
        for (const rate of [60, 75, 120, 144, 165, 240, 1500]) {
            const scene = hanging();
            let time = 0;
            let scenes = 0; // largest deviations [m]: of the scene, and of what is drawn
            let drawn = 0;
            for (let i = 0; i < 3 * rate; i++) {
                const elapsed = 1 / rate + uniform(-noise, noise);
                time += Math.max(0, elapsed);
                withHand(scene, elapsed, [speed * time, 0, 0]);
                const [pin, , , end] = [...scene.get("position", 0, 1), ...scene.get("position", 19, 1)];
                scenes = Math.max(scenes, Math.abs(end - pin));
                const shown = speed * (time - 1 / 960); // one step behind
                if (scene.time > 0) drawn = Math.max(drawn, Math.abs(scene.positions[57] - shown));
            }
            assert.ok(scenes < 1e-5 && drawn < 1e-5, `${rate} fps: by ${scenes} m, drawn ${drawn} m`);
            scene.free();
        }
});

await test("the program of README: a long frame does not stretch the rope, and none fails with maxSpeed", () => {
    const swing = Array.from({ length: 60 }, (_, i) => [speed, 0, i / 19][i % 3]); // [m/s] up to 3 m/s sideways
    const stretched = (hitch) => {
        const scene = hanging({ maxSpeed: 3 * speed, velocity: swing });
        let time = 0;
        let most = 0;
        for (let i = 0; i < 600; i++) {
            time += i === 200 ? hitch : 1 / 144;
            withHand(scene, i === 200 ? hitch : 1 / 144, [speed * time, 0, 0]);
            most = Math.max(most, longest(scene));
        }
        scene.free();
        return most;
    };
    const usual = stretched(1 / 144);
    for (const hitch of [0.25, 5, 60]) {
        const more = stretched(hitch) / usual - 1;
        assert.ok(more <= 0.1, `after a frame of ${hitch} s the longest link is longer by ${more}`);
    }
});

await test("pins, drive, masses", () => {
    const scene = rope({ editable: true });
    scene.pin(4);
    scene.drive(4, [1, 1], 0.1);
    scene.advance("leapfrog", 1e-3, 100);
    const [x, y] = scene.get("position", 4);
    assert.ok(Math.abs(x - 1) < 1e-12 && Math.abs(y - 1) < 1e-12, `${x} ${y}`);
    scene.drive(4, null);
    scene.advance("leapfrog", 1e-3, 100);
    assert.deepEqual([...scene.get("velocity", 4)], [0, 0]);
    scene.unpin(4);
    scene.setMass([1e6], 3);
    const [, before] = scene.get("velocity", 3);
    scene.advance("leapfrog", 1e-3);
    assert.ok(Math.abs(scene.get("velocity", 3)[1] - before + 9.81e-3) < 1e-6);
    scene.free();
});

await test("links: get, set, cut, tear, tension, pieces", () => {
    const scene = rope({ editable: true });
    assert.deepEqual(scene.getLink(2), { a: 2, b: 3, rest: 0.5, stiffness: 300, damping: 0.2, flags: 0 });
    assert.equal(scene.findLink(3, 2), 2);
    assert.equal(scene.findLink(0, 2), -1);
    scene.setLink(2, { rest: 0.4 });
    assert.equal(scene.tension(2), 300 * (0.5 - 0.4));
    const links = scene.getLinks();
    links.stiffness.fill(600);
    scene.setLinks(links);
    assert.equal(scene.getLink(0).stiffness, 600);
    assert.deepEqual([...scene.tear(1.2)], [2]);
    assert.deepEqual([...scene.tear(Infinity)], []);
    assert.deepEqual([...scene.tear([0.5, Infinity, 0.5, Infinity])], [0]);
    scene.cut(3);
    assert.deepEqual([...scene.components().component], [0, 1, 1, 2, 3]);
    assert.equal(components(3, [{ a: 0, b: 2, rest: 1, stiffness: 1 }]).count, 2);
    scene.free();
});

await test("flags of links, bending, tethers, attachments", () => {
    const sheet = { count: [9, 9], spacing: 0.1 };
    const cloth = {
        ...grid({ ...sheet, stiffness: 20, families: ["structural", "shear"], pinned: ["firstY"] }),
        mass: 0.01,
        gravity: [0, 9.81, 0],
        drag: 0.02,
    };
    const { pinned } = cloth;
    const weightedLinks = bendGrid(sheet, 1e-3, { pinned, diagonals: false });
    assert.equal(weightedLinks.stiffness.length, 2 * 63 - 7); // none in the pinned row
    const links = tethers(cloth);
    const added = 9 * 7; // the second row is next to the pins
    assert.equal(links.flags.length, cloth.links.flags.length + added);
    assert.ok(links.flags.subarray(-added).every((flag) => flag === TETHER));
    assert.deepEqual([...links.ends.subarray(-2)], [80, 8]);
    const lowest = [cloth, { ...cloth, links, weightedLinks }].map((definition) => {
        const scene = new Scene(definition);
        scene.advance("leapfrog", 1 / 480, 4800);
        const y = Math.max(...scene.get("position").filter((_, i) => i % 3 === 1));
        scene.free();
        return y;
    });
    assert.ok(lowest[0] > 0.87 && lowest[1] < 0.82, String(lowest));

    const position = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, 0];
    const lamp = new Scene({
        position,
        pinned: [1, 1, 1, 0],
        gravity: [0, 0, -10],
        weightedLinks: {
            particles: [3, 0, 1, 2],
            weights: [-1, 0.5, 0.25, 0.25],
            stiffness: 400,
            damping: 2,
        },
    });
    lamp.advance("leapfrog", 0.01, 1000);
    assert.ok(Math.abs(lamp.get("position", 3)[2] + 10 / 400) < 1e-6);
    lamp.free();
    const slack = { a: 0, b: 1, rest: 2, stiffness: 5, flags: TENSION_ONLY };
    const pair = new Scene({ position: position.slice(0, 6), links: [slack] });
    assert.equal(pair.tension(0), 0);
    assert.equal(pair.getLinks().flags[0], TENSION_ONLY);
    pair.free();
    const rod = bendRod([0, 0, 1, 0, 3, 0, 4, 0], 6, { axes: 2, dampingTime: 0.5 });
    assert.deepEqual([...rod.particles.subarray(0, 3)], [0, 1, 2]);
    assert.deepEqual([...rod.stiffness], [9, 9]);
    assert.equal(rod.damping[1], 4.5);
});

await test("a mesh with a seam", () => {
    const position = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0];
    const triangles = [0, 1, 2, 3, 5, 4];
    const mesh = fromMesh({ position, triangles, stiffness: 30, damping: 0.5 });
    assert.deepEqual([...mesh.particleOf], [0, 1, 2, 1, 2, 3]);
    assert.deepEqual([...mesh.triangles], [0, 1, 2, 1, 3, 2]);
    assert.deepEqual([...mesh.links.ends], [0, 1, 0, 2, 1, 2, 1, 3, 2, 3]);
    assert.equal(mesh.links.rest[2], Math.SQRT2);
    const bend = bendMesh(mesh.position, mesh.triangles, 2);
    assert.deepEqual([...bend.particles, ...bend.stiffness], [1, 2, 0, 3, 2]);
    assert.equal(fromMesh({ position, triangles, stiffness: 30, weld: null }).links.rest.length, 6);
    const scene = new Scene({ position: mesh.position, links: mesh.links, weightedLinks: bend });
    scene.free();
});

await test("soften() and tethers() throw where no links do what they promise", () => {
    const sheet = { count: [5, 5], spacing: 10 };
    const cloth = { ...grid({ ...sheet, stiffness: 1000, pinned: ["lastY"] }), mass: 0.01 };
    const weightedLinks = bendGrid(sheet, 5e4, { pinned: cloth.pinned });
    refused(
        () => soften({ ...cloth, weightedLinks }, 1 / 120),
        `RangeError: dt must be short enough for weightedLinks, which keep their stiffness, got ${1 / 120}`,
    );
    for (const [fraction, slack] of [
        [1e308, 0],
        [0.05, 1e308],
    ])
        refused(
            () => tethers(cloth, fraction, slack),
            `RangeError: fraction and slack must be small enough for links with finite values, got [${[fraction, slack]}]`,
        );
});

await test("slack links do not push", () => {
    const two = { axes: 2, position: [0, 0, 1, 0], pinned: [1, 0] };
    for (const tensionOnly of [false, true]) {
        const scene = new Scene({ ...two, links: [{ a: 0, b: 1, rest: 2, stiffness: 5 }], tensionOnly });
        scene.advance("leapfrog", 1e-3, 10);
        assert.equal(scene.get("velocity", 1)[0] > 0, !tensionOnly);
        scene.free();
    }
});

await test("held forces act until they are changed", () => {
    const scene = new Scene({ axes: 1, position: [0, 0], mass: [1, 2], heldForces: true });
    scene.set("force", [3], 1);
    scene.advance("leapfrog", 0.5, 4);
    assert.deepEqual([...scene.get("velocity")], [0, 3]);
    assert.deepEqual([...scene.get("force")], [0, 3]);
    scene.free();
});

await test("transform, by rows and as a Matrix4 has it; gravity; at rest; base and component", () => {
    const scene = new Scene({
        axes: 1,
        position: [1, 2],
        component: 1,
        base: [5, 0, 6, 7, 0, 8],
    });
    assert.deepEqual([...scene.positions], [5, 1, 6, 7, 2, 8]);
    assert.ok(scene.atRest(0, 0));
    scene.setGravity([2]);
    assert.ok(!scene.atRest(0, 1));
    scene.advance("euler", 1);
    assert.deepEqual([...scene.get("velocity")], [2, 2]);
    scene.free();
    const flat = new Scene({ position: [1, 2, 3] });
    flat.transform([0, -1, 0, 10, 1, 0, 0, 20, 0, 0, 1, 30]);
    assert.deepEqual([...flat.positions], [8, 21, 33]);
    flat.transform([0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 10, 20, 30, 1]);
    assert.deepEqual([...flat.get("position")], [-11, 28, 63]);
    flat.free();
});

await test("contacts: accelerating bodies, belts and impulses", () => {
    const scene = new Scene({ position: [2, 0, 0], mass: [0.5], gravity: [0, -10, 0], colliders: 2 });
    scene.setColliders([{ shape: "sphere", at: [0, 9, 0], radius: 1 }, { shape: "plane" }]);
    scene.advance("leapfrog", 1 / 128, 64);
    const { linear, angular } = scene.impulse(1); // m g t, at 2 m from the origin
    assert.ok(Math.abs(linear[1] + 2.5) < 1e-12 && Math.abs(angular[2] + 5) < 1e-12, `${linear} ${angular}`);
    assert.deepEqual(Array.from(scene.impulse(0).linear), [0, 0, 0]);
    refused(() => scene.impulse(2), "RangeError: collider: 2, but the scene has fewer colliders now");
    refused(() => rope().impulse(0), "TypeError: the scene is defined without colliders");
    scene.setColliders([{ shape: "plane", surface: [3, 0, 0], friction: 0.5 }]);
    scene.advance("leapfrog", 1 / 128, 256); // 0.6 s until it moves with the belt
    assert.ok(Math.abs(scene.get("velocity")[0] - 3) < 1e-12);
    scene.setColliders([{ shape: "plane", acceleration: [0, 4, 0], spinAcceleration: [0, 1, 0] }]);
    scene.advance("leapfrog", 1 / 128, 128);
    assert.ok(Math.abs(scene.get("position")[1] - 2) < 1e-12, "4/2 m in a second");
    scene.free();
});

await test("the impulses of a frame are those of all its steps", () => {
    const body = { shape: "plane", normal: [0, 1, 0], velocity: [3, 0, 0], friction: 0.25 };
    const definition = { position: [2, 0, 0], mass: [0.5], gravity: [0, -10, 0], colliders: 2 };
    const [a, b] = [1, 2].map(() => new Scene(definition));
    for (const scene of [a, b]) scene.setColliders([{ shape: "sphere", at: [0, 9, 0], radius: 1 }, body]);
    const saved = a.snapshot();
    const all = (scene) =>
        [0, 1].flatMap((i) => Object.values(scene.impulse(i)).flatMap((each) => [...each]));
    const close = (x, y) =>
        x.forEach((each, i) => assert.ok(Math.abs(each - y[i]) < 1e-13, `${x}, not ${y}`));
    for (const steps of [8, 1, 5]) {
        assert.equal(a.frame("leapfrog", 1 / 128, steps / 128), steps);
        b.advance("leapfrog", 1 / 128, steps);
        close(all(a), all(b));
        assert.ok(all(a)[7] < -0.03 * steps, String(all(a)));
    }
    const before = all(a);
    const move = () => {
        a.setColliders([body]);
        assert.deepEqual([...a.impulse(0).linear], [0, 0, 0]);
        throw new Error("mine");
    };
    assert.throws(() => a.frame("leapfrog", 1 / 128, 0.1, { move }), /mine/);
    assert.deepEqual(all(a), before, "those of before a frame that fails");
    const later = a.snapshot();
    a.advance("leapfrog", 1 / 128, 5);
    b.advance("leapfrog", 1 / 128, 5);
    close(all(a), all(b));
    a.restore(later);
    assert.deepEqual(all(a), before);
    assert.equal(a.frame("leapfrog", 1 / 128, 1e-4), 0);
    assert.deepEqual(all(a), Array(12).fill(0), "a frame without steps");
    for (const change of [
        () => a.setColliders(a.getColliders()),
        () => a.load(a.save()),
        () => a.restore(saved),
    ]) {
        a.frame("leapfrog", 1 / 128, 0.1);
        assert.notEqual(all(a)[7], 0);
        change();
        assert.deepEqual(all(a), Array(12).fill(0));
    }
    a.free();
    b.free();
});

await test("a callback that throws in any evaluation changes nothing", () => {
    const links = {
        ...grid({ count: [4], spacing: 1, stiffness: 10, pinned: ["firstX"] }),
        gravity: [0, -1, 0],
    };
    for (const method of methods)
        for (const takes of [(s) => s.advance(method, 0.01, 3), (s) => s.frame(method, 0.01, 0.03)]) {
            let left = Infinity;
            const force = () => {
                if (left-- === 0) throw new Error("mine");
            };
            const scene = new Scene({ ...links, methods: [method], force });
            const all = () => [
                scene.time,
                ...scene.get("position"),
                ...scene.get("velocity"),
                ...scene.positions,
            ];
            scene.frame(method, 0.01, 0.025);
            const before = all();
            const first = scene.snapshot();
            for (let evaluation = 0; left !== Infinity || evaluation === 0; evaluation++) {
                left = evaluation;
                try {
                    takes(scene);
                    left = Infinity;
                } catch (error) {
                    assert.equal(error.message, "mine");
                    assert.deepEqual(all(), before, `${method}: evaluation ${evaluation}`);
                    left = Infinity;
                    takes(scene);
                    scene.restore(first);
                    left = 0;
                }
            }
            scene.free();
        }
    const pinned = new Scene({ position: [0, 0, 0], velocity: [1, 0, 0], pinned: [1] });
    pinned.force = () => {
        throw new Error("mine");
    };
    assert.throws(() => pinned.advance("leapfrog", 0.5, 4), /mine/);
    assert.deepEqual([pinned.time, pinned.positions[0]], [2, 2], "pinned particles move on, and are shown");
    pinned.free();
});

await test("a frame that fails also undoes restore() and load() of move()", () => {
    const run = (change) => {
        const scene = new Scene({ position: [0, 0, 0], velocity: [1, 0, 0] });
        scene.frame(0.015, { dt: 0.01 });
        const [snapshot, state] = [scene.snapshot(), scene.save()];
        for (let i = 0; i < 10; i++) scene.frame(0.013, { dt: 0.01 });
        const move = () => {
            change(scene, snapshot, state);
            throw new Error("mine");
        };
        assert.throws(() => scene.frame(0.02, { dt: 0.01, move }), /mine/);
        const failed = [scene.time, scene.positions[0]];
        return [...failed, scene.frame(0.006, { dt: 0.01 }), scene.time, scene.positions[0]];
    };
    const wanted = run(() => {});
    assert.deepEqual(
        run((scene, snapshot) => scene.restore(snapshot)),
        wanted,
    );
    assert.deepEqual(
        run((scene, _, state) => scene.load(state)),
        wanted,
    );
});

await test("colliders at their present places", () => {
    const scene = new Scene({ position: [9, 9, 9], mass: [0.5], colliders: 4 });
    assert.deepEqual(scene.getColliders(), []);
    const bodies = [
        { shape: "plane", at: [0, -1, 0], normal: [0, 2, 0], friction: 0.5 },
        { shape: "sphere", at: [0, 0, 9], radius: 0.5, velocity: [1, 0, 0], acceleration: [0, 2, 0] },
        { shape: "capsule", at: [0, 0, 0], to: [1, 0, 0], radius: 0.25, velocityTo: [0, 1, 0] },
        { shape: "box", at: [0, 0, -9], half: [1, 2, 1], spin: [0, 0, 2], mask: 3 },
    ];
    scene.setColliders(bodies);
    scene.advance("leapfrog", 1 / 1024, 512);
    const [plane, ball, capsule, box] = scene.getColliders();
    assert.deepEqual([plane.normal, plane.friction, plane.radius], [[0, 1, 0], 0.5, undefined]);
    assert.deepEqual([ball.at, ball.velocity, ball.radius], [[0.5, 0.25, 9], [1, 1, 0], 0.5]);
    assert.deepEqual(
        [capsule.to, capsule.velocityTo],
        [
            [1, 0.5, 0],
            [0, 1, 0],
        ],
    );
    assert.deepEqual([box.half, box.mask], [[1, 2, 1], 3]);
    assert.ok(Math.hypot(box.axes[0] - Math.cos(1), box.axes[1] - Math.sin(1)) < 1e-14);
    const other = new Scene({ position: [9, 9, 9], mass: [0.5], colliders: 4 });
    other.setColliders([plane, ball, capsule, box]);
    assert.deepEqual(other.getColliders(), [plane, ball, capsule, box]);
    scene.free();
    other.free();
});

await test("normals: unit vectors of any length, which stay as they are", () => {
    const scene = new Scene({ position: [9, 9, 9], colliders: 1 });
    const normalOf = (normal) =>
        borrowed((take) => [...memory.float64(lendColliders(take, [{ shape: "plane", normal }], 2) + 56, 3)]);
    for (let i = 0; i < 3000; i++) {
        const size = 10 ** (chance(0.5) ? uniform(-307, 307) : uniform(-2, 2));
        const normal = Array.from({ length: chance(0.3) ? 2 : 3 }, () => size * uniform(-1, 1));
        const [x, y, z = 0] = normal;
        const unit = normalOf(normal);
        const q = x * x + y * y + z * z;
        if (q > 1e-280 && q < 1e280)
            assert.deepEqual(
                unit,
                [x, y, z].map((each) => each / Math.sqrt(q)),
            );
        const [u, v, w] = [x / size, y / size, z / size]; // moderate
        unit.forEach((each, k) =>
            assert.ok(Math.abs(each - [u, v, w][k] / Math.sqrt(u * u + v * v + w * w)) < 1e-15),
        );
        assert.deepEqual(normalOf(unit), unit);
        if (i % 10) continue;
        scene.setColliders([{ shape: "plane", normal: [x, y, z] }]);
        const colliders = scene.getColliders();
        assert.deepEqual(colliders[0].normal, unit);
        scene.setColliders(colliders);
        assert.deepEqual(scene.getColliders(), colliders);
    }
    const tiny = Number.MIN_VALUE;
    assert.deepEqual(normalOf([0, -tiny, 0]), [0, -1, 0]);
    for (const normal of [
        [0, 0],
        [NaN, 1],
        [0, Infinity, 0],
        [1e200, -Infinity],
    ])
        refused(() => normalOf(normal), "RangeError: colliders[0].normal must be a direction, got...");
    scene.free();
});

await test("contacts: radius, friction and mask of particles, mask of colliders", () => {
    const definition = {
        position: [0, 1, 0, 2, 1, 0, 4, 1, 0, 6, 1, 0],
        velocity: [1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0],
        gravity: [0, -10, 0],
        colliders: 2,
        particleRadius: [0.1, 0.2, 0, 0.3],
        particleFriction: Float64Array.of(1, 0, 1, 1),
        particleMask: [1, 3, 0x80000000, 0],
    };
    const scene = new Scene(definition);
    scene.setColliders([
        { shape: "plane", friction: 1, mask: 1 },
        { shape: "plane", at: [0, -1, 0], friction: 1, mask: 0xfffffffe },
    ]);
    scene.advance("leapfrog", 1 / 512, 1024);
    const [x, v] = [scene.get("position"), scene.get("velocity")];
    const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-12, `${a}, not ${b}`);
    for (const [i, height] of [0.1, 0.2, -1, 1 - 20].entries()) near(x[3 * i + 1], height);
    for (const [i, speed] of [0, 1, 0, 1].entries()) near(v[3 * i], speed);
    assert.deepEqual([...scene.touching()], [1, 1, 2, 0]);
    const state = scene.save();
    new Scene(definition).load(state);
    assert.throws(() => new Scene({ ...definition, particleMask: [1, 3, 4, 0] }).load(state), RangeError);
    refused(
        () => scene.setColliders([{ shape: "plane", mask: -1 }]),
        "RangeError: colliders[0].mask must be an integer from 0 to 4294967295, got -1",
    );
    for (const [more, wanted] of [
        [
            { particleRadius: [0, -1, 0, 0] },
            "RangeError: particleRadius[1] must be a finite number >= 0, got -1",
        ],
        [
            { particleFriction: [0, 0, NaN, 0] },
            "RangeError: particleFriction[2] must be a finite number >= 0, got NaN",
        ],
        [
            { particleMask: [1, 0.5, 0, 0] },
            "RangeError: particleMask[1] must be an integer from 0 to 4294967295, got 0.5",
        ],
        [{ particleMask: [1] }, "RangeError: particleMask.length must be 4, got 1"],
        [{ particleFriction: 1 }, "TypeError: particleFriction must be an array, got 1"],
    ])
        refused(() => new Scene({ ...definition, ...more }), wanted);
    scene.free();
});

await test("contacts: shapes, motion, friction, which touch", () => {
    const drop = (collider, more = {}) => {
        const scene = new Scene({
            position: [0.3, 1, 0],
            gravity: [0, -10, 0],
            colliders: 2,
            particleRadius: 0.1,
            ...more,
        });
        scene.setColliders(collider ? [collider] : []);
        scene.advance("leapfrog", 1e-3, 2000);
        const state = [...scene.get("position"), ...scene.get("velocity"), scene.touching()[0]];
        scene.free();
        return state;
    };
    const close = (a, b) => assert.ok(Math.abs(a - b) < 1e-9, `${a}, not ${b}`);
    assert.ok(drop(null)[1] < -18);
    const plane = drop({ shape: "plane", normal: [0, 7, 0] });
    close(plane[1], 0.1);
    assert.equal(plane[6], 1);
    close(drop({ shape: "box", at: [0, -1, 0], half: [1, 0.5, 1], radius: 0.2 })[1], -0.2);
    const lifted = drop({ shape: "plane", at: [0, -2, 0], velocity: [0, 1, 0] });
    close(lifted[1], 0.1); // the plane has risen by 2 m
    close(lifted[4], 1);
    const ball = drop({ shape: "sphere", at: [0.3, 0, 0], radius: 0.5 }); // on its top
    close(ball[1], 0.6);
    close(
        drop({ shape: "capsule", at: [-1, 0, 0], to: [1, 0, 0], radius: 0.5, velocity: [0, 0, 0] })[1],
        0.6,
    );
    const slides = drop({ shape: "plane" }, { velocity: [1, 0, 0] });
    close(slides[3], 1);
    const stops = drop({ shape: "plane", friction: 1 }, { velocity: [1, 0, 0] });
    close(stops[3], 0);
    const flat = new Scene({ axes: 2, position: [0, 1], gravity: [0, -10], colliders: 1 });
    flat.setColliders([{ shape: "plane", at: [0, 0], normal: [0, 1], restitution: 1 }]);
    flat.advance("leapfrog", 1e-3, 500);
    assert.ok(flat.get("velocity")[1] > 0);
    for (const [collider, wanted] of [
        [
            { shape: "cone" },
            'TypeError: colliders[0].shape must be one of plane, sphere, capsule, box, got "cone"',
        ],
        [
            { shape: "sphere", radius: -1 },
            "RangeError: colliders[0].radius must be a finite number >= 0, got -1",
        ],
        [{ shape: "plane", at: [0, NaN] }, "RangeError: colliders[0].at[1] must be a finite number, got NaN"],
        [
            { shape: "plane", normal: [0, 0, 0] },
            "RangeError: colliders[0].normal must be a direction, got [0,0,0]",
        ],
        [
            { shape: "plane", restitution: 2 },
            "RangeError: colliders[0].restitution must be a number from 0 to 1, got 2",
        ],
        [
            { shape: "box", half: [-1, 1, 1] },
            "RangeError: colliders[0].half must be numbers >= 0, got [-1,1,1]",
        ],
        [
            { shape: "plane", normal: [0, 0, 1] },
            "RangeError: colliders[0].normal must be a direction in the plane of the scene, got [0,0,1]",
        ],
        [
            { shape: "plane", friction: -1 },
            "RangeError: colliders[0].friction must be a finite number >= 0...",
        ],
        [
            { shape: "box", half: [1, 1], axes: [1, 0, 0, 1, 0, 0, 0, 0, 1] },
            "RangeError: colliders[0].axes must be orthonormal to 1e-3, got [1,0,0,1,0,0,0,0,1]",
        ],
        [{ shape: "box", half: [1] }, "RangeError: colliders[0].half.length must be 2 or 3, got 1"],
        [{ shape: "plane", at: [] }, "RangeError: colliders[0].at.length must be 2 or 3, got 0"],
        [{ shape: "plane", at: null }, "TypeError: colliders[0].at must be an array, got null"],
        [{ shape: "plane", normal: null }, "TypeError: colliders[0].normal must be an array, got null"],
        [
            { shape: "box", half: [1, 1], axes: [1, 0, 0, 1] },
            "RangeError: colliders[0].axes.length must be 9, got 4",
        ],
        [{ shape: "box", colour: 1 }, "TypeError: the option colour is unknown"],
        [{ shape: "sphere" }, "TypeError: colliders[0].radius is required"],
        [{ shape: "capsule", radius: 1 }, "TypeError: colliders[0].to is required"],
        [{ shape: "box", radius: 1 }, "TypeError: colliders[0].half is required"],
        [
            { shape: "sphere", radius: 1, half: [1, 1] },
            "TypeError: colliders[0]: the option half does not go with sphere",
        ],
    ])
        refused(() => flat.setColliders([collider]), wanted);
    const sphere = { shape: "sphere", radius: 1 };
    const none = rope();
    for (const [run, wanted] of [
        [() => flat.setColliders([sphere, sphere]), "RangeError: colliders.length must be at most..."],
        [() => flat.advance("euler", 1e-3), "TypeError: the method euler does not support colliders"],
        [() => none.setColliders([sphere]), "TypeError: the scene is defined without colliders"],
        [() => none.touching(), "TypeError: the scene is defined without colliders"],
        [
            () => new Scene({ position: [0, 0, 0], colliders: 1 }).setColliders([{ ...sphere, at: [0, 0] }]),
            "RangeError: colliders[0].at.length must be 3, got 2",
        ],
        [
            () => new Scene({ axes: 1, position: [0], colliders: 1 }),
            "RangeError: axes must be 2 or 3 with colliders, got 1",
        ],
        [() => rope({ colliders: 33 }), "RangeError: colliders must be an integer from 0 to 32, got 33"],
        [
            () => rope({ particleRadius: -1 }),
            "RangeError: particleRadius must be a finite number >= 0, got -1",
        ],
    ])
        refused(run, wanted);
    flat.free();
    none.free();
});

await test("soften makes steps stable", () => {
    const definition = { ...grid({ count: [9, 9], spacing: 0.1, stiffness: 1e6 }), mass: 0.01 };
    const dt = 1 / 240;
    const scene = new Scene({ ...definition, links: soften(definition, dt) });
    assert.ok(dt <= 0.5 * scene.stableStep() * (1 + 1e-12) && 0.5 * scene.stableStep() <= 1.4 * dt);
    scene.free();
});

await test("a callback: forces by position and velocity; what it throws; it cannot call its scene", () => {
    const seen = [];
    const scene = new Scene({
        axes: 2,
        position: [1, 0],
        velocity: [0, 3],
        forceUsesVelocity: true,
        force(t, [x, y], [fx, fy], [vx, vy]) {
            seen.push([t, x[0], y[0], vx[0], vy[0]]);
            fx[0] -= 4 * x[0];
            fy[0] -= 4 * y[0];
        },
    });
    scene.advance("leapfrog", 1e-3);
    assert.deepEqual(seen[0], [0, 1, 0, 0, 3]);
    assert.ok(Math.abs(scene.get("velocity")[0] + 4e-3) < 1e-8);
    const hash = hashOf(scene);
    scene.force = (t) => {
        if (t > 0.002) throw new SyntaxError("mine");
    };
    assert.throws(() => scene.advance("leapfrog", 1e-3, 5), { name: "SyntaxError", message: "mine" });
    assert.equal(hashOf(scene), hash);
    const { buffer } = library().memory;
    const size = Math.ceil(Math.sqrt(buffer.byteLength / 100));
    scene.force = (t, x, [fx]) => {
        fx.fill(1);
        if (t > 0.002) new Scene({ ...grid({ count: [size, size], spacing: 1, stiffness: 1 }) }).free();
    };
    refused(
        () => scene.advance("leapfrog", 1e-3, 5),
        "TypeError: memory grew during force: create scenes...",
    );
    assert.notEqual(library().memory.buffer, buffer);
    assert.equal(hashOf(scene), hash);
    scene.advance("leapfrog", 1e-3, 5); // there is enough memory now
    scene.force = async () => {};
    const moved = hashOf(scene);
    refused(() => scene.advance("leapfrog", 1e-3), "TypeError: force must be synchronous, got...");
    assert.equal(hashOf(scene), moved);
    for (const call of [() => scene.time, () => scene.free(), () => scene.advance("leapfrog", 1)]) {
        scene.force = call;
        assert.throws(() => scene.advance("leapfrog", 1e-3), /must not call its own scene/);
    }
    scene.force = null;
    scene.advance("leapfrog", 1e-3);
    scene.free();
});

await test("snapshots include the clock of frames", () => {
    for (let run = 0; run < 40; run++) {
        const scene = rope();
        const frames = Array.from({ length: 12 }, () => uniform(-0.002, 0.02));
        const play = (list) =>
            list.map((elapsed) => [
                scene.frame("leapfrog", 1e-3, elapsed),
                hashOf(scene),
                ...scene.positions,
            ]);
        play(frames.slice(0, run % 6));
        const saved = scene.snapshot();
        const shown = scene.positions.slice();
        const first = play(frames.slice(6));
        if (run % 2) scene.transform([2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]);
        scene.restore(saved);
        assert.deepEqual(scene.positions, shown);
        if (run % 3 === 0) {
            const move = () => scene.frame("leapfrog", 1e-3, 1); // fails
            assert.throws(() => scene.frame("leapfrog", 1e-3, 0.01, { move }), TypeError);
            assert.deepEqual(scene.positions, shown, "also those of a frame that fails");
            scene.restore(saved);
        }
        assert.deepEqual(play(frames.slice(6)), first);
        scene.free();
    }
});

await test("snapshots: back to them, with the callback; none of another scene", () => {
    const push = (t, x, [fx]) => fx.fill(1);
    const scene = rope({ force: push });
    const saved = scene.snapshot();
    scene.advance("leapfrog", 1e-3, 50);
    const hash = hashOf(scene);
    scene.force = null;
    scene.advance("leapfrog", 1e-3, 50);
    scene.restore(saved);
    assert.equal(scene.time, 0);
    assert.equal(scene.force, push);
    scene.advance("leapfrog", 1e-3, 50);
    assert.equal(hashOf(scene), hash);
    const other = rope();
    assert.throws(() => other.restore(saved), /snapshot must be a snapshot of this scene/);
    assert.throws(() => other.restore({}), TypeError);
    scene.free();
    other.free();
});

await test("errors name field and value, and change nothing", () => {
    const good = { axes: 2, position: [0, 0, 1, 0], links: [{ a: 0, b: 1, rest: 1, stiffness: 5 }] };
    const scene = (more) => () => new Scene({ ...good, ...more });
    const names = offered()
        .map(({ name }) => name)
        .join(", ");
    const finite = "a finite number >= 0, also when it is divided by a mass";
    for (const [more, wanted] of [
        [{ axes: 4 }, "RangeError: axes must be 1, 2 or 3, got 4"],
        [{ position: [0, 0, 1] }, "RangeError: position.length must be a multiple of 2, got 3"],
        [{ position: 3 }, "TypeError: position must be an array, got 3"],
        [{ position: [0, 0, NaN, 0] }, "RangeError: position[2] must be a finite number, got NaN"],
        [{ velocity: [0, 0, 0, Infinity] }, "RangeError: velocity[3] must be a finite number, got Infinity"],
        [{ velocity: [0] }, "RangeError: velocity.length must be 4, got 1"],
        [
            { mass: [1, -2] },
            "RangeError: mass[1] must be a finite number > 0 with a finite reciprocal, got -2",
        ],
        [{ mass: 0 }, "RangeError: mass must be a finite number > 0 with a finite reciprocal, got 0"],
        [{ pinned: [1] }, "RangeError: pinned.length must be 2, got 1"],
        [{ gravity: [0, NaN, 0, 0] }, "RangeError: gravity.length must be 2 or 3, got 4"],
        [{ axes: 3, position: [0, 0, 1], gravity: [0, 1] }, "RangeError: gravity.length must be 3, got 2"],
        [{ gravity: [0, NaN] }, "RangeError: gravity[1] must be a finite number, got NaN"],
        [{ drag: -1 }, `RangeError: drag must be ${finite}, got -1`],
        [{ drag: "1" }, 'TypeError: drag must be a finite number, got "1"'],
        [{ maxSpeed: -1 }, "RangeError: maxSpeed must be a finite number >= 0, got -1"],
        [{ methods: ["rk5"] }, `TypeError: method must be one of ${names}, got "rk5"`],
        [{ methods: ["rkn8"], tensionOnly: true }, "TypeError: rkn8 and srkn6 require undamped links..."],
        [{ axes: 1, tensionOnly: true }, "TypeError: tensionOnly requires 2 or 3 axes"],
        [{ colour: 1 }, "TypeError: the option colour is unknown"],
        [{ force: 1 }, "TypeError: force must be a function or null, got 1"],
        [{ tensionOnly: "no" }, 'TypeError: tensionOnly must be a boolean, got "no"'],
        [{ forceUsesVelocity: 1 }, "TypeError: forceUsesVelocity must be a boolean, got 1"],
        [{ component: 2 }, "RangeError: component must be an integer from 0 to 1, got 2"],
        [{ base: [0, 0, 0, 0, NaN, 0] }, "RangeError: base[4] must be a finite number, got NaN"],
        [{ base: [0, 0, "q", 0, 0, 0] }, 'TypeError: base[2] must be a finite number, got "q"'],
        [
            { links: [{ a: 0, b: 2, rest: 1, stiffness: 1 }] },
            "RangeError: links[0].b must be the index of ano...",
        ],
        [
            { links: [{ a: -1, b: 1, rest: 1, stiffness: 1 }] },
            "RangeError: links[0].a must be the index of a particle, got -1",
        ],
        [
            { links: [{ a: 0, b: 1, rest: 1, stiffness: -3 }] },
            `RangeError: links[0].stiffness must be ${finite}, got -3`,
        ],
        [
            { links: [{ a: 0, b: 1, rest: 1 }] },
            "TypeError: links[0].stiffness must be a number, got undefined",
        ],
        [
            { links: { ends: [0, 1], rest: [1, 2], stiffness: 1 } },
            "RangeError: links.rest.length must be 1, got 2",
        ],
        [
            { links: { ends: [0], rest: 1, stiffness: 1 } },
            "RangeError: links.ends.length must be even, got 1",
        ],
    ])
        refused(scene(more), wanted);
    for (const [more, wanted] of [
        [{ count: [1, 2, 3, 4] }, "RangeError: count.length must be 1, 2 or 3, got 4"],
        [{ count: [0] }, "RangeError: count[0] must be an integer >= 1, got 0"],
        [{ spacing: -1 }, "RangeError: spacing must be a finite number > 0, got -1"],
        [{ count: [1e5, 1e5] }, "RangeError: count must be small enough..."],
        [{ count: [2e4, 2e4] }, "RangeError: no memory for..."],
        [{ pinned: ["top"] }, "TypeError: pinned must be a list of..."],
    ])
        refused(() => grid({ count: [3], spacing: 1, stiffness: 1, ...more }), wanted);
    const one = scene({})();
    const hash = hashOf(one);
    for (const [run, wanted] of [
        [() => one.setGravity([0]), "RangeError: gravity.length must be 2 or 3, got 1"],
        [() => one.advance("leapfrog", NaN), "RangeError: dt must be a finite number, got NaN"],
        [() => one.advance("leapfrog", 0.1, -1), "RangeError: steps must be an integer >= 0, got -1"],
        [() => one.advance("rk4", 0.1), "TypeError: the scene is defined without the method rk4"],
        [() => one.frame("leapfrog", 0, 1), "RangeError: dt must be a finite number > 0, got 0"],
        [() => one.frame("leapfrog", 1, NaN), "RangeError: elapsed must be a finite number, got NaN"],
        [
            () => one.frame("leapfrog", 1, 1, 0),
            "RangeError: mostSteps must be an integer >= 1 and < 2^32, got 0",
        ],
        [() => one.frame(), "TypeError: elapsed must be a finite number, got undefined"],
        [() => one.frame(undefined, { dt: 1 }), "TypeError: elapsed must be a finite number, got undefined"],
        [() => one.frame("0.1"), 'TypeError: elapsed must be a finite number, got "0.1"'],
        [() => one.frame("rk5", 1, 1), "TypeError: method must be one of..."],
        [() => one.frame(0.1, { dt: 1e-12 }), "RangeError: dt must be at least 1e-10 without mostSteps..."],
        [() => one.frame("leapfrog", 1, 1, { most: 3 }), "TypeError: the option most is unknown"],
        [() => one.frame("leapfrog", 1, 1, { move: 3 }), "TypeError: move must be a function or null, got 3"],
        [() => one.setLink(0, { stifness: 3 }), "TypeError: the option stifness is unknown"],
        [() => bendRod([0, 0, 0, 0, 0, 0], 1), "RangeError: position must be finite, and different from..."],
        [() => bendGrid({ count: [2, 2, 2], spacing: 1 }, 1), "RangeError: count must be that of a sheet"],
        [() => (one.gravity = [0, 0]), "TypeError: Cannot add property gravity..."],
        [() => one.set("position", [1, NaN]), "RangeError: position[1] must be a finite number, got NaN"],
        [() => one.set("position", [1, 2], 2), "RangeError: first + count must be at most 2, got 3"],
        [() => one.set("speed", [1, 2]), "TypeError: quantity must be one of..."],
        [() => one.set("force", [1, 2]), "TypeError: the scene is defined without heldForces"],
        [() => one.get("position", -1), "RangeError: first must be an integer from 0 to 2, got -1"],
        [() => one.get("position", 9), "RangeError: first must be an integer from 0 to 2, got 9"],
        [() => one.pin(0), "TypeError: the scene is defined without editable"],
        [() => one.tear(1), "TypeError: the scene is defined without editable"],
        [
            () => one.drive(0, [1, 1], 1),
            "RangeError: particle must be pinned, and its velocity finite, got 0",
        ],
        [() => one.drive(7, null), "RangeError: particle must be an index below 2, got 7"],
        [() => one.getLink(1), "RangeError: link must be an index below 1, got 1"],
        [() => one.transform([1]), "RangeError: matrix.length must be 12 or 16, got 1"],
    ])
        refused(run, wanted);
    assert.equal(hashOf(one), hash);
    one.free();
    one.free();
    refused(() => one.time, "TypeError: the scene has been freed");
});

await test("edits that are refused name field, value and index, and change nothing", () => {
    const scene = rope({ editable: true, drag: 1 });
    scene.frame("leapfrog", 1e-3, 0.0105);
    const all = () => [...scene.save(), ...scene.positions, ...scene.get("velocity")];
    const before = all();
    const links = (field, i, value) => {
        const changed = scene.getLinks();
        changed[field][i] = value;
        return () => scene.setLinks(changed);
    };
    const finite = "a finite number >= 0, also when it is divided by a mass";
    const reciprocal = "a finite number > 0 with a finite reciprocal, also times stiffness or drag";
    for (const [run, wanted] of [
        [() => scene.setLink(3, { stiffness: -1 }), `stiffness of link 3 must be ${finite}, got -1`],
        [links("rest", 2, NaN), "rest of link 2 must be a finite number >= 0, got NaN"],
        [links("damping", 1, Infinity), `damping of link 1 must be ${finite}, got Infinity`],
        [links("stiffness", 3, 1e308), `stiffness of link 3 must be ${finite}, got 1e+308`],
        [links("damping", 0, 1e308), `damping of link 0 must be ${finite}, got 1e+308`],
        [links("ends", 2, 3), "ends of link 1 must be 1 and 2, got [3,2]"],
        [() => scene.setLink(2, { b: 4 }), "ends of link 2 must be 2 and 3, got [2,4]"],
        [() => scene.setMass([2, 1e-320], 1), `mass[1] must be ${reciprocal}, got 1e-320`],
        [() => scene.setMass([2, 3, 1e-307, 1], 1), `mass[2] must be ${reciprocal}, got 1e-307`],
    ]) {
        refused(run, `RangeError: ${wanted}`);
        assert.deepEqual(all(), before);
    }
    const text = { ...scene.getLink(3), stiffness: "3" };
    const wanted = 'stiffness must be a number, got "3"';
    refused(() => scene.setLink(3, { stiffness: "3" }), `TypeError: links[3].${wanted}`);
    refused(() => scene.setLinks([text], 3), `TypeError: links[0].${wanted}`);
    scene.free();
});

await test("elements of arrays must be numbers, and messages name option and index", () => {
    const two = { position: [0, 0, 0, 1, 0, 0] };
    const scene = new Scene({ ...two, links: [{ a: 0, b: 1, rest: 1, stiffness: 5 }], editable: true });
    const weighted = { particles: [0, 1, 0, 0], weights: [1, -1, 0, 0], stiffness: [3] };
    const rows = [
        ["position", [0, 0, 0, 1, 0, 0], 4, "a finite number", (position) => new Scene({ position })],
        ["velocity", [0, 0, 0, 1, 0, 0], 5, "a finite number", (velocity) => new Scene({ ...two, velocity })],
        ["mass", [1, 2], 1, "a finite number > 0 with a...", (mass) => new Scene({ ...two, mass })],
        [
            "particleRadius",
            [1, 2],
            0,
            "a finite number >= 0",
            (each) => new Scene({ ...two, particleRadius: each }),
        ],
        [
            "particleFriction",
            [1, 2],
            1,
            "a finite number >= 0",
            (each) => new Scene({ ...two, particleFriction: each }),
        ],
        ["gravity", [0, 0, 0], 2, "a finite number", (gravity) => new Scene({ ...two, gravity })],
        ["gravity", [0, 0, 0], 1, "a finite number", (gravity) => scene.setGravity(gravity)],
        ["stretch", [2], 0, "a number >= 0", (stretch) => scene.tear(stretch)],
        ["position", [0, 0, 0, 1, 0, 0, 2, 0, 0], 3, "a finite number", (position) => bendRod(position, 1)],
        ...["weights", "stiffness"].map((name) => [
            `weightedLinks.${name}`,
            weighted[name],
            0,
            "a number",
            (each) => new Scene({ ...two, weightedLinks: { ...weighted, [name]: each } }),
        ]),
    ];
    for (const [name, good, i, what, use] of rows) {
        for (const [wrong, shown] of [
            [null, "null"],
            ["1", '"1"'],
            [true, "true"],
            [1n, "1n"],
        ]) {
            const end = what.endsWith("...") ? "" : `, got ${shown}`;
            refused(
                () => use(Object.assign([...good], { [i]: wrong })),
                `TypeError: ${name}[${i}] must be ${what}${end}`,
            );
        }
        use({ length: good.length, ...good });
    }
    refused(() => scene.set("velocity", BigInt64Array.of(1n, 2n, 3n)), "TypeError: velocity[0] must be...");
    refused(() => new Scene({ position: new BigInt64Array(3) }), "TypeError: position[0] must be...");
    scene.free();
});

await test("setLink() changes what it is given", () => {
    const scene = rope({ editable: true });
    const before = scene.getLinks();
    scene.setLink(2, { rest: undefined, stiffness: undefined, damping: undefined });
    assert.deepEqual(scene.getLinks(), before);
    refused(
        () => scene.setLink(2, { damping: null }),
        "TypeError: links[2].damping must be a number, got null",
    );
    for (const changes of [null, 5, undefined])
        refused(() => scene.setLink(2, changes), `TypeError: changes must be an object, got ${changes}`);
    assert.deepEqual(scene.getLinks(), before);
    scene.free();
});

await test("options that are not objects, and callbacks that are async, are refused", () => {
    const scene = new Scene({ axes: 2, position: [0, 0, 1, 0], colliders: 1 });
    const box = (more) => () => scene.setColliders([{ shape: "box", half: [1, 1], ...more }]);
    const object = (name, value) => `TypeError: ${name} must be an object, got ${value}`;
    for (const [run, wanted] of [
        [() => scene.frame(1 / 60, 8), object("options", 8)],
        [() => scene.frame(1 / 60, null), object("options", "null")],
        [() => scene.frame(1 / 60, () => {}), "TypeError: options must be an object, got..."],
        [() => scene.frame("leapfrog", 1e-3, 1 / 60, null), object("options", "null")],
        [
            () => scene.frame("leapfrog", 1e-3, 1 / 60, () => {}),
            "TypeError: options must be an object, got...",
        ],
        [
            () => scene.frame(1 / 60, { move: async () => {} }),
            "TypeError: move must be synchronous, got [object Promise]",
        ],
        [
            () => new Scene(grid({ count: [3], spacing: 1, stiffness: 1 })).frame(1, { method: "euler" }),
            "TypeError: dt must be given, because the stable step of euler is 0, got undefined",
        ],
        [() => new Scene({ position: [0, 0, 0], links: [null] }), object("links[0]", "null")],
        [() => new Scene({ position: [0, 0, 0], links: 3 }), object("links", 3)],
        [() => new Scene({ position: [0, 0, 0], weightedLinks: 3 }), object("weightedLinks", 3)],
        [() => bendGrid({ count: [3, 3], spacing: 1 }, 1, null), object("options", "null")],
        [() => bendGrid(null, 1), object("grid", "null")],
        [() => fromMesh(null), object("mesh", "null")],
        [box({ spin: [0, 1] }), "RangeError: colliders[0].spin.length must be 3, got 2"],
        [
            box({ spinAcceleration: [0, 1] }),
            "RangeError: colliders[0].spinAcceleration.length must be 3, got 2",
        ],
    ])
        refused(run, wanted);
    assert.equal(scene.time, 0);
    scene.setColliders([{ shape: "plane", normal: { length: 2, 0: 0, 1: 1 } }]);
    assert.deepEqual(scene.getColliders()[0].normal, [0, 1, 0]);
    scene.free();
});

await test("a getter of an element may create a scene", () => {
    const size = {
        position: [1, 2, 3, 4, 5, 6],
        velocity: [6, 5, 4, 3, 2, 1],
        particleMask: [1, 2],
        mass: [7, 8],
    };
    const links = [{ a: 0, b: 1, rest: 1, stiffness: 5 }];
    const wanted = new Scene({ ...size, links }).save();
    const others = [];
    const watched = (object) =>
        Object.defineProperties(
            { length: object.length },
            Object.fromEntries(
                Object.entries(object).map(([i, value]) => {
                    const get = () => {
                        others.push(new Scene({ position: new Float64Array(3e5) })); // memory grows
                        return value;
                    };
                    return [i, { get, enumerable: true }];
                }),
            ),
        );
    const evil = Object.fromEntries(Object.entries(size).map(([name, values]) => [name, watched(values)]));
    const { length, ...link } = Object.getOwnPropertyDescriptors(watched(links[0]));
    const scene = new Scene({ ...evil, links: [Object.defineProperties({}, link)] });
    assert.ok(others.length > 0);
    assert.deepEqual(scene.save(), wanted);
    for (const each of others) each.free();
});

await test("scenes above 2 GiB of memory", () => {
    const program = `import { grid, Scene } from ${JSON.stringify(new URL("../scenes.js", import.meta.url))};
        import { library } from ${JSON.stringify(new URL("../module.js", import.meta.url))};
        const run = () => {
            const scene = new Scene({ ...grid({ count: [9, 9], spacing: 1, stiffness: 1 }), gravity: [1, 2, 3],
                editable: true, colliders: 1, force: (t, x, [fx]) => fx.fill(1) });
            scene.setColliders([{ shape: "plane" }]);
            scene.frame(0.1);
            const saved = scene.snapshot();
            scene.advance("leapfrog", 1e-3, 10);
            const state = scene.save();
            scene.restore(saved);
            scene.load(state);
            scene.tear(9);
            return [...scene.positions, ...scene.get("velocity"), ...scene.save(), scene.getLink(3).rest].join();
        };
        const below = run();
        const { malloc } = library();
        if (malloc(2 ** 31) === 0) console.log("no memory");
        else {
            for (let bytes = 2 ** 24; bytes >= 8; bytes /= 2) while (malloc(bytes) > 0); // all that is below
            console.log(run() === below, malloc(8) < 0);
        }`;
    const how = ["--input-type=module", "--eval", program];
    const { stdout, stderr } = spawnSync(process.execPath, how, { encoding: "utf8" });
    if (stdout === "no memory\n") return note("this machine has no 2 GiB for them");
    assert.equal(stdout + stderr, "true true\n");
});

await test("an explosion throws with a code, and the state is the one before", () => {
    const scene = rope();
    scene.advance("leapfrog", 1e-3, 10);
    const hash = hashOf(scene);
    assert.throws(() => scene.advance("euler", 1, 1e4), {
        code: "SPRING_ENONFINITE",
        message: /dt is 1, the stable step of euler is/,
    });
    assert.equal(hashOf(scene), hash);
    scene.free();
});

await test("memory is aligned, taken once at a time, and used again", () => {
    const { malloc, free, memory } = library();
    const blocks = [];
    const release = () => {
        const [{ at, bytes, mark }] = blocks.splice(Math.floor(uniform(0, blocks.length)), 1);
        assert.ok(new Uint8Array(memory.buffer, at, bytes).every((byte) => byte === mark));
        free(at);
    };
    let largest = 0;
    for (let round = 0; round < 4; round++) {
        for (let i = 0; i < 2000; i++) {
            if (blocks.length > 0 && chance(0.5)) release();
            const bytes = Math.floor(logarithmic(1, 1e5));
            const at = malloc(bytes);
            assert.ok(at > 0 && at % 8 === 0);
            blocks.push({ at, bytes, mark: i % 256 });
            new Uint8Array(memory.buffer, at, bytes).fill(i % 256);
        }
        while (blocks.length > 0) release();
        if (round === 0) largest = memory.buffer.byteLength;
        const all = malloc(largest / 2); // freed blocks are joined
        assert.ok(all > 0);
        free(all);
    }
    assert.ok(memory.buffer.byteLength < 2 * largest, `${memory.buffer.byteLength} bytes after ${largest}`);
    assert.equal(malloc(2 ** 32 - 1), 0);
    free(0);
});

await test("1000 scenes share an instance; memory is released by free, using and the garbage collector", async () => {
    const size = { count: [40, 40], spacing: 0.1, stiffness: 1 };
    const bytes = () => process.memoryUsage().arrayBuffers + process.memoryUsage().external;
    const make = () => new Scene(grid(size));
    for (let i = 0; i < 20; i++) make().free();
    const before = bytes();
    for (let i = 0; i < 1000; i++) {
        const scene = make();
        if (i % 2) scene.free();
        else scene[Symbol.dispose ?? Symbol.for("Symbol.dispose")]();
    }
    const grown = bytes() - before;
    assert.ok(grown < 2e7, `grown by ${grown} bytes`);
    assert.equal(compiled, 1);
    if (!globalThis.gc) return;
    const held = [];
    for (let round = 0; round < 20; round++) {
        for (let i = 0; i < 50; i++) make();
        globalThis.gc();
        await new Promise((resolve) => setTimeout(resolve, 5));
        held.push(bytes());
    }
    assert.ok(held[19] - held[9] < 5e7, `from ${held[9]} to ${held[19]} bytes`);
});

done();
