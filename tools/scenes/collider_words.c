/* SPDX-License-Identifier: MIT */
/* Colliders as words of a command line; see collider_words.h. */
#include "collider_words.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const shape_names[] = {
    [SPRING_PLANE] = "plane", [SPRING_SPHERE] = "sphere", [SPRING_CAPSULE] = "capsule", [SPRING_BOX] = "box"};

enum { shape_count = sizeof shape_names / sizeof shape_names[0] };

/* The values of a word, in the order of its fields. */
typedef struct collider_numbers {
    double at[3], to[3], normal[3], half[3], radius, velocity[3], spin[3], friction, restitution;
    double accel[3], spin_accel[3], surface[3], mask;
} collider_numbers;

typedef enum number_range { ANY, NOT_NEGATIVE, FRACTION, BITS } number_range;

enum {
    FOR_PLANE = 1 << SPRING_PLANE,
    FOR_SPHERE = 1 << SPRING_SPHERE,
    FOR_CAPSULE = 1 << SPRING_CAPSULE,
    FOR_BOX = 1 << SPRING_BOX,
    FOR_ALL = FOR_PLANE | FOR_SPHERE | FOR_CAPSULE | FOR_BOX
};

typedef struct collider_field {
    const char *name;
    size_t offset; /* in collider_numbers */
    int shapes;
    number_range range;
} collider_field;

#define AT(member) offsetof(collider_numbers, member)
static const collider_field fields[] = {
    {"x", AT(at[0]), FOR_ALL, ANY},
    {"y", AT(at[1]), FOR_ALL, ANY},
    {"z", AT(at[2]), FOR_ALL, ANY},
    {"nx", AT(normal[0]), FOR_PLANE, ANY},
    {"ny", AT(normal[1]), FOR_PLANE, ANY},
    {"nz", AT(normal[2]), FOR_PLANE, ANY},
    {"x2", AT(to[0]), FOR_CAPSULE, ANY},
    {"y2", AT(to[1]), FOR_CAPSULE, ANY},
    {"z2", AT(to[2]), FOR_CAPSULE, ANY},
    {"hx", AT(half[0]), FOR_BOX, NOT_NEGATIVE},
    {"hy", AT(half[1]), FOR_BOX, NOT_NEGATIVE},
    {"hz", AT(half[2]), FOR_BOX, NOT_NEGATIVE},
    {"radius", AT(radius), FOR_SPHERE | FOR_CAPSULE | FOR_BOX, NOT_NEGATIVE},
    {"vx", AT(velocity[0]), FOR_ALL, ANY},
    {"vy", AT(velocity[1]), FOR_ALL, ANY},
    {"vz", AT(velocity[2]), FOR_ALL, ANY},
    {"wx", AT(spin[0]), FOR_ALL, ANY},
    {"wy", AT(spin[1]), FOR_ALL, ANY},
    {"wz", AT(spin[2]), FOR_ALL, ANY},
    {"friction", AT(friction), FOR_ALL, NOT_NEGATIVE},
    {"restitution", AT(restitution), FOR_ALL, FRACTION},
    {"ax", AT(accel[0]), FOR_ALL, ANY},
    {"ay", AT(accel[1]), FOR_ALL, ANY},
    {"az", AT(accel[2]), FOR_ALL, ANY},
    {"wax", AT(spin_accel[0]), FOR_ALL, ANY},
    {"way", AT(spin_accel[1]), FOR_ALL, ANY},
    {"waz", AT(spin_accel[2]), FOR_ALL, ANY},
    {"sx", AT(surface[0]), FOR_ALL, ANY},
    {"sy", AT(surface[1]), FOR_ALL, ANY},
    {"sz", AT(surface[2]), FOR_ALL, ANY},
    {"mask", AT(mask), FOR_ALL, BITS},
};
#undef AT
enum { field_count = sizeof fields / sizeof fields[0] };

static bool in_range(double value, number_range range)
{
    if (range == BITS)
        return value >= 0 && value <= UINT32_MAX && value == floor(value);
    return isfinite(value) && (range == ANY || value >= 0) && (range != FRACTION || value <= 1);
}

static const char *range_words(number_range range)
{
    static const char *const words[] = {"a finite number", "a finite number >= 0", "a number from 0 to 1",
                                        "an integer from 0 to 2^32 - 1"};
    return words[range];
}

static spring_shape read_shape(const char *word, const char **rest)
{
    const size_t length = strcspn(word, ":");
    *rest = word + length + (word[length] == ':');
    for (int shape = 0; shape < shape_count; shape++)
        if (strlen(shape_names[shape]) == length && strncmp(word, shape_names[shape], length) == 0)
            return (spring_shape)shape;
    cli_fail(CLI_USAGE,
             "--collider: \"%s\" does not begin with a shape; it should be plane:, sphere:, capsule: or box:", word);
}

static void list_fields(spring_shape shape, char text[300])
{
    text[0] = '\0';
    for (int i = 0; i < field_count; i++)
        if (fields[i].shapes & 1 << shape) {
            strcat(text, text[0] == '\0' ? "" : " ");
            strcat(text, fields[i].name);
        }
}

static const collider_field *read_field(const char *word, spring_shape shape, const char *text, size_t length)
{
    for (int i = 0; i < field_count; i++)
        if (strlen(fields[i].name) == length && strncmp(text, fields[i].name, length) == 0 &&
            fields[i].shapes & 1 << shape)
            return &fields[i];
    char known[300];
    list_fields(shape, known);
    cli_fail(CLI_USAGE, "--collider: \"%.*s\" in \"%s\" is not a field of a %s; it should be one of %s", (int)length,
             text, word, shape_names[shape], known);
}

/* Returns a pointer past FIELD=VALUE. */
static const char *read_number(const char *word, spring_shape shape, const char *text, collider_numbers *n)
{
    const size_t length = strcspn(text, "=,"), rest = strcspn(text, ",");
    const collider_field *f = read_field(word, shape, text, length);
    const char *number = text + length + 1;
    char *end;
    const double value = text[length] == '=' ? strtod(number, &end) : NAN;
    if (text[length] != '=' || end != text + rest || end == number || strchr("+-.0123456789", number[0]) == NULL ||
        !in_range(value, f->range))
        cli_fail(CLI_USAGE, "--collider: \"%.*s\" in \"%s\" is not valid; %s should be %s", (int)rest, text, word,
                 f->name, range_words(f->range));
    memcpy((char *)n + f->offset, &value, sizeof value);
    return text + rest + (text[rest] == ',');
}

/* On two axes, the second axis is z. */
static void put(const double from[3], uint32_t axes, double to[3])
{
    to[0] = from[0], to[1] = from[axes == 2 ? 2 : 1], to[2] = axes == 2 ? 0 : from[2];
}

static void put_spin(const double spin[3], uint32_t axes, double to[3])
{
    if (axes == 2)
        to[2] = -spin[1]; /* about the axis away from a viewer who sees x to the right and z up: -y */
    else
        put(spin, axes, to);
}

/* Components that are not given are NaN. The default is upwards if all are missing, otherwise missing ones are 0. */
static void complete_normal(double normal[3])
{
    const bool given = !isnan(normal[0]) || !isnan(normal[1]) || !isnan(normal[2]);
    for (int i = 0; i < 3; i++)
        if (isnan(normal[i]))
            normal[i] = given || i < 2 ? 0 : 1;
}

static void make_axes(const char *word, collider_numbers *n, uint32_t axes, spring_collider *c)
{
    if (c->shape == SPRING_BOX)
        for (int i = 0; i < 3; i++)
            c->axis[i][i] = 1;
    if (c->shape != SPRING_PLANE)
        return;
    double normal[3];
    complete_normal(n->normal);
    put(n->normal, axes, normal);
    const double length = hypot(hypot(normal[0], normal[1]), normal[2]);
    if (!(length > 0 && isfinite(length)))
        cli_fail(CLI_USAGE, "--collider: \"%s\" has no normal; %s should not all be 0", word,
                 axes == 2 ? "nx and nz" : "nx, ny and nz");
    for (int i = 0; i < 3; i++)
        c->axis[0][i] = normal[i] / length;
}

static spring_collider read_collider(const char *word, uint32_t axes)
{
    const char *text;
    spring_collider c = {.shape = read_shape(word, &text)};
    collider_numbers n = {.normal = {NAN, NAN, NAN}};
    while (*text != '\0')
        text = read_number(word, c.shape, text, &n);
    put(n.at, axes, c.at);
    put(n.to, axes, c.to);
    put(n.half, axes, c.half);
    put(n.velocity, axes, c.velocity);
    put(n.velocity, axes, c.velocity_to);
    put_spin(n.spin, axes, c.spin);
    make_axes(word, &n, axes, &c);
    put(n.accel, axes, c.acceleration);
    put_spin(n.spin_accel, axes, c.spin_acceleration);
    put(n.surface, axes, c.surface);
    c.radius = n.radius, c.friction = n.friction, c.restitution = n.restitution, c.mask = (uint32_t)n.mask;
    return c;
}

void collider_words_read(const cli_words *words, uint32_t axes, spring_collider c[MOST_COLLIDERS])
{
    if (words->count > MOST_COLLIDERS)
        cli_fail(CLI_USAGE, "--collider: \"%s\" is collider %d; a scene has at most %d", words->word[MOST_COLLIDERS],
                 MOST_COLLIDERS + 1, MOST_COLLIDERS);
    for (size_t i = 0; i < words->count; i++)
        c[i] = read_collider(words->word[i], axes);
}
