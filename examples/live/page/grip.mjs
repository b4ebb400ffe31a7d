// SPDX-License-Identifier: MIT
// Grabs a particle and drags it no faster than the scene can follow.

export class Hand {
    constructor(lab) {
        const { settings, definition } = lab.preset;
        const spacing = lab.length / (settings.size - 1);
        // [m/s] Half the wave speed, at which links stretch to two or three times their length at most.
        this.fastest = 0.5 * spacing * Math.sqrt(settings.stiffness / settings.mass);
        this.shown = { 1: [2], 2: [0, 2], 3: [0, 1, 2] }[definition.axes]; // axes of the scene in x y z with z up
        this.lab = lab;
        this.particle = null;
        this.target = [0, 0, 0];
    }

    grab(particle) {
        this.release();
        if (!(particle < this.lab.particles)) return;
        this.lab.scene.pin(particle);
        this.particle = particle;
        this.target = [...this.lab.now.slice(3 * particle, 3 * particle + 3)];
    }

    release() {
        const { scene, pinned } = this.lab;
        if (this.particle !== null && pinned[this.particle]) scene.drive(this.particle, null);
        else if (this.particle !== null) scene.unpin(this.particle);
        this.particle = null;
    }

    /** Moves the particle so that it would reach the target after `time` [s], if it is fast enough. */
    pull(time) {
        if (this.particle === null) return;
        const { scene } = this.lab;
        const position = scene.get("position", this.particle, 1);
        const way = this.shown.map((axis, a) => this.target[axis] - position[a]);
        const part = Math.min(1, (this.fastest * time) / Math.hypot(...way));
        const to = way.map((each, a) => position[a] + part * each);
        scene.drive(this.particle, part < 1 ? to : this.shown.map((axis) => this.target[axis]), time);
    }
}
