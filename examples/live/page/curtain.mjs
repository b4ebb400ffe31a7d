// SPDX-License-Identifier: MIT
// A curtain that tears, and a sphere that is pushed through it. spring-scene has no such scene.

const length = 2; // [m]
const mass = 0.01; // [kg] of a particle
const stiffness = 500; // [N/m]

/** As preset() of tools/scenes/presets.mjs. */
export function curtain(grid, { size: n = 25, damping = 0 }) {
    const spacing = length / (n - 1);
    const made = grid({ count: [n, n], spacing, families: ["structural", "shear"], stiffness, damping });
    for (let j = 0, at = 0; j < n; j++)
        for (let i = 0; i < n; i++, at += 3)
            made.position.set([i * spacing, 0.03 * Math.sin(i * spacing * 9), -j * spacing], at);
    made.pinned.fill(1, 0, n);
    const definition = {
        ...made,
        mass,
        gravity: [0, 0, -9.81],
        drag: 0.01,
        tensionOnly: true,
        colliders: 1,
        particleRadius: spacing / 4,
    };
    const settings = { scene: "curtain", size: n, length, mass, stiffness, damping };
    return { definition, count: [n, n, 1], start: Float64Array.from(made.position), settings };
}

const front = -0.7; // [m] where a sphere appears; below, where it vanishes
const back = 1.1;
const speed = 5; // [m/s]
const fastest = 4; // [m/s] sideways, following the pointer

/** A sphere that moves away from the viewer and follows a pointer sideways. */
export class Sphere {
    constructor(x, z) {
        Object.assign(this, { at: [x, front, z], target: [x, z], radius: 0.24, held: true });
    }

    /** [x, y, z, radius] */
    get place() {
        return [...this.at, this.radius];
    }

    get gone() {
        return !this.held && this.at[1] >= back;
    }

    /** Advances the sphere, which follows a pointer that is `late` seconds ahead. Returns its collider at the start. */
    advance(duration, late) {
        const { at, target, radius } = this;
        const [dx, dz] = [target[0] - at[0], target[1] - at[2]];
        const part = Math.min(duration / (duration + late), (fastest * duration) / (Math.hypot(dx, dz) || 1));
        const way = [part * dx, Math.min(speed * duration, back - at[1]), part * dz];
        this.at = at.map((each, axis) => each + way[axis]);
        const velocity = way.map((each) => each / duration);
        return { shape: "sphere", at, radius, velocity, friction: 0.3 };
    }
}
