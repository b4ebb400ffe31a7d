// SPDX-License-Identifier: MIT
// The cloth as a curtain, and the sphere that is pushed through it.
import { SphereGeometry } from "three";

import { Cloth } from "./cloth.mjs";
import { plain } from "./light.mjs";

export class Curtain extends Cloth {
    static camera = { from: [1.3, -4.8, -0.5], to: [0, 0.2, -1.05], fit: 1.1 };

    constructor(info, theme) {
        super(info, theme);
        this.sphere = this.mesh(new SphereGeometry(1, 40, 28), plain("0.25, 0.42, 0.66", 0.6));
        this.sphere.visible = false;
        this.group.add(this.sphere);
    }

    update(picture) {
        super.update(picture);
        const { ball } = picture;
        this.sphere.visible = ball !== null;
        if (!ball) return;
        this.sphere.position.set(...ball.slice(0, 3));
        this.sphere.scale.setScalar(ball[3]);
    }
}
