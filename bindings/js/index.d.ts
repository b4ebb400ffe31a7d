// SPDX-License-Identifier: MIT

/** Parameters of a spring, in one of five forms. Times are in seconds. */
export type SpringParameters =
    | {
          /** >= 0 */
          stiffness: number;
          /** >= 0 */
          damping: number;
          /** > 0; default 1 */
          mass?: number;
      }
    | {
          /** 2 pi / undamped angular frequency; > 0 */
          response: number;
          /** damping ratio, >= 0; default 1, which does not overshoot */
          dampingFraction?: number;
      }
    | {
          /** 2 pi / undamped angular frequency; > 0 */
          duration: number;
          /** -1 to 1; default 0, which does not overshoot. 1 never stops. */
          bounce?: number;
      }
    | {
          /** undamped frequency, >= 0 */
          hertz: number;
          /** >= 0; default 1, which does not overshoot */
          dampingRatio?: number;
      }
    | {
          /** time in which the amplitude halves; > 0 */
          halfLife: number;
          /** > 0; default 1, which does not overshoot */
          dampingRatio?: number;
      };

export type SpringsOptions = SpringParameters & {
    /** A value settles if its distance from the target is at most this; default 0.001. */
    restDelta?: number;
    /** A value settles if its speed per second is at most this; default 0.01. */
    restSpeed?: number;
};

export type SpringOptions = SpringsOptions & {
    /** see Spring.clamp; default false */
    clamp?: boolean;
    /** see Spring.onRest; default null */
    onRest?: ((spring: Spring) => void) | null;
};

/** A value that follows a target. Bad input throws a RangeError or TypeError and changes nothing. */
export declare class Spring {
    /** At rest on its target `value`, which is 0 by default. The default options are `{ duration: 0.5 }`. */
    constructor(value?: number, options?: SpringOptions);

    readonly value: number;

    /** Velocity, in units of the value per second. Set it when a gesture ends, for example. */
    velocity: number;

    /** Target. A new target keeps value and velocity. */
    target: number;

    /** Whether the value is at rest on its target. step() has no effect then. */
    readonly settled: boolean;

    /** Stop at the target instead of overshooting, however long the step. */
    clamp: boolean;

    /** Called once each time the spring settles during step(). */
    onRest: ((spring: Spring) => void) | null;

    /** Places value and target at `value`, at rest. Does not call onRest. */
    jump(value: number): void;

    /**
     * Advances by `dt` seconds, of any length, and returns the value. Value and velocity are bit-identical to those of
     * spring_follow() in C. If they would overflow, step() throws a RangeError and changes nothing. A settled spring stays
     * at rest on its target.
     */
    step(dt: number): number;
}

/** Many values with the same parameters, each with its own target. */
export declare class Springs {
    /** Values, velocities and targets are 0. The default options are `{ duration: 0.5 }`. */
    constructor(count: number, options?: SpringsOptions);

    readonly target: Float64Array;
    readonly value: Float64Array;
    readonly velocity: Float64Array;

    /**
     * Advances by `dt` seconds, of any length, and returns the number of values that still move. If a target is not finite or
     * a value would overflow, that value keeps its state, the others are advanced, and step() throws a RangeError.
     */
    step(dt: number): number;
}
