/* SPDX-License-Identifier: MIT */
/* Colliders as words of a command line: SHAPE:FIELD=VALUE,... */
#ifndef SPRINGSTEP_COLLIDER_WORDS_H
#define SPRINGSTEP_COLLIDER_WORDS_H

#include <springstep/scene.h>

#include "common/cli.h"

enum { MOST_COLLIDERS = 32 }; /* of a scene */

/**
 * Reads the colliders of an option --collider.
 *
 * Coordinates are those of preset_positions(), with z up. A scene on two axes has x and z.
 *
 * Any error ends the program with a message.
 *
 * @param[in]  axes  2 or 3
 * @param[out] c     [words->count]
 */
void collider_words_read(const cli_words *words, uint32_t axes, spring_collider c[MOST_COLLIDERS]);

#endif
