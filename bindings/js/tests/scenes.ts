// SPDX-License-Identifier: MIT
// A program in TypeScript that uses the declarations of springstep/scenes, for tests/js.
import { components, grid, hasSimd, methods, ready, Scene, soften } from "springstep/scenes";
import type { Collider, Force, GridDefinition, Links, SceneDefinition } from "springstep/scenes";

if (hasSimd()) await ready();
const sheet: GridDefinition = {
    count: [9, 9],
    spacing: 0.1,
    stiffness: 4e4,
    families: ["structural", "shear", "bend"],
    pinned: ["firstY"],
};
const wind: Force = (t, position, force) => {
    force[2]?.forEach((before, i, z) => (z[i] = before + 0.01 * Math.min(t, 1)));
};
const definition: SceneDefinition = {
    ...grid(sheet),
    mass: 0.01,
    gravity: [0, -9.81, 0],
    drag: 0.01,
    maxSpeed: 100,
    methods: ["leapfrog", "rk4"],
    editable: true,
    tensionOnly: true,
    heldForces: true,
    colliders: 1,
    particleRadius: 0.01,
    particleMask: new Uint32Array(81).fill(3),
    force: wind,
};
const floor: Collider = { shape: "plane", at: [0, 0, -9], normal: [0, 0, 1], friction: 0.5, mask: 2 };
const links: Links = soften(definition, 1 / 600);
let time: number;
let torn: number;
{
    using cloth = new Scene({ ...definition, links });
    cloth.setColliders([floor]);
    const start = cloth.snapshot();
    cloth.advance("leapfrog", 1 / 600, 10);
    cloth.frame("rk4", 1 / 1200, 1 / 60, 30);
    cloth.frame("rk4", 1 / 1200, -1, {
        mostSteps: 30,
        move: (time, dropped) => cloth.drive(0, null, time + dropped),
    });
    cloth.set("force", new Float64Array(3 * cloth.particles));
    cloth.pin(80);
    cloth.drive(80, [0.8, 0.8, 1], 0.5);
    cloth.advance("leapfrog", 1 / 600, 300);
    torn = cloth.tear(1.5).length + cloth.components().count + cloth.touching().length;
    cloth.setLink(0, { rest: 0.2 });
    cloth.setLinks([cloth.getLink(1)], 1);
    cloth.transform([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 5]);
    const z = cloth.positions[2];
    const { total } = cloth.energy;
    cloth.restore(start);
    const state: Uint8Array = cloth.save();
    new Blob([cloth.save()]);
    const gravity: ArrayLike<number> = { length: 3, 0: 0, 1: -9.81, 2: 0 };
    cloth.setGravity(gravity);
    cloth.load(state);
    cloth.setTime(0);
    time = cloth.time + (z === 5 && total !== 0 && cloth.tension(0) === 0 ? 0 : 1);
}
// @ts-expect-error: a sphere has a radius
const shapeless = (s: Scene) => s.setColliders([{ shape: "sphere" }]);
// @ts-expect-error: of a plane
const turned = (s: Scene) => s.setColliders([{ shape: "sphere", radius: 1, normal: [0, 1, 0] }]);
// @ts-expect-error: no such method
const wrong = (s: Scene) => s.advance("verlet", 1);
// @ts-expect-error: positions are refilled, not replaced
const assign = (s: Scene) => (s.positions = new Float64Array(3));

console.log(
    time,
    torn > 0,
    components(2, []).count +
        (methods()[0]?.order ?? 0) +
        wrong.length +
        assign.length +
        shapeless.length +
        turned.length -
        2,
);
