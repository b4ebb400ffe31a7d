// SPDX-License-Identifier: MIT
// The scenes of the page: their settings, their texts, and the commands with bit-identical results.

/** steps: per frame of 1/60 s, each half the stable step of leapfrog, as in spring-scene; speed: of the playback; more:
    bending stiffness [N m] and tethers, as options of spring-scene; own: not a scene of spring-scene. */
export const presets = {
    water: { steps: 13, speed: 1 / 8, sizes: [17, 25, 33, 49] },
    cloth: { steps: 19, speed: 1, sizes: [13, 25, 33], more: { bend: 1e-3, tethers: 0.05 } },
    rope: { steps: 7, speed: 1, sizes: [10, 20, 40] },
    jelly: { steps: 9, speed: 1, sizes: [5, 8, 10] },
    curtain: { steps: 15, speed: 1, sizes: [19, 25, 33], own: true },
};

/** A rope with an end 10^4 times as heavy as its other particles, which requires stiff links and many steps. */
export const heavyEnd = { drag: 0, mass: 0.01, endMass: 100, stiffness: 2e5 };
export const heavySteps = 150;

export function commandOf(run, method, steps, duration) {
    const words = ["spring-scene", "--scene", run.scene, "--method", method, "--frame-rate", "60"];
    words.push("--steps-per-frame", `${steps}`, "--duration", `${duration}`, "--hash");
    for (const [name, value] of Object.entries(run))
        if (name !== "scene") words.push(name === "endMass" ? "--end-mass" : `--${name}`, `${value}`);
    return words;
}

/** What to try, what it shows, and the corresponding figure of the report. */
export const sentences = {
    water: [
        "Poke it, let it rain, drop the ball. Then choose Euler: the water explodes, where leapfrog stays calm with the same work. With 300 steps a frame you can watch Euler's waves grow.",
        "index.html#water-euler-explodes",
    ],
    cloth: [
        "Pull a fold, blow, or pull hard until it tears. Then take fewer steps a frame: up to the stable step nothing happens, not far above it leapfrog shreds the cloth, and Runge–Kutta 4 is next.",
        "evidence.html#cloth",
    ],
    rope: [
        "Swing it by its end. Then give it a heavy end, ten thousand times as heavy as a link, and pull that: it stays a rope, and its energy stays. What the weight costs is steps: take fewer, and see.",
        "evidence.html#rope",
    ],
    jelly: [
        "Pull a corner and let go. Put Euler beside leapfrog: the same springs, the same steps, and one of them tears itself apart.",
        "evidence.html#scene-energy",
    ],
    curtain: [
        "Press on it to push a sphere through, and drag it to the sides. Links pull and never push, they tear where they get too long, and no particle passes through the sphere, however fast it is.",
        "evidence.html#contacts",
    ],
};
