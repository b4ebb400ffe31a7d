/* SPDX-License-Identifier: MIT */
/* The grid of a sweep; see grid.h. */
#include "sweep/grid.h"

#include <ctype.h>
#include <inttypes.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t most_points = UINT64_C(1) << 53;
static const uint64_t most_blocks = 16384; /* enough to give work to 10^4 machines; more if blocks would be too large */

void grid_init(grid *g)
{
    *g = (grid){.scene = SWEEP_SPRING};
}

void grid_clear(grid *g)
{
    for (size_t i = 0; i < g->axes; i++)
        free(g->axis[i].list);
    g->axes = 0;
}

#if defined(__GNUC__)
__attribute__((format(printf, 2, 3)))
#endif
static bool
refuse(grid *g, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(g->message, sizeof g->message, format, arguments);
    va_end(arguments);
    return false;
}

bool grid_set_scene(grid *g, const char *name)
{
    const char *word;
    for (int i = 0; (word = sweep_scene_name(i)) != NULL; i++) {
        if (strcmp(word, name) == 0) {
            g->scene = i;
            return true;
        }
    }
    return refuse(g, "\"%s\" is not a scene", name);
}

/* ------------------------------------------------------------------------------------------------------------- axes */

/* base^exponent for 0 <= exponent < 1, from the binary digits of the exponent and repeated square roots. pow() differs
   between C libraries in the last digits. This function has an error of at most 53 roundings and is reproducible. */
static double power(double base, double exponent)
{
    double result = 1;
    for (double root = base; exponent > 0;) {
        root = sqrt(root);
        exponent *= 2;
        if (exponent >= 1) {
            result *= root;
            exponent -= 1;
        }
    }
    return result;
}

/* Rounds to 12 digits, so that 0.1 is 0.1, unless neighbours on the axis would become equal. */
static double round_digits(const axis *a, double x)
{
    char text[32];
    if (!(fabs(a->last - a->first) > 1e-10 * (double)(a->count - 1) * fmax(fabs(a->first), fabs(a->last))))
        return x;
    snprintf(text, sizeof text, "%.11e", x);
    return strtod(text, NULL);
}

static double axis_value(const axis *a, uint64_t i)
{
    const double last = (double)(a->count - 1);
    if (a->kind == AXIS_LIST)
        return a->list[i];
    if (i == 0)
        return a->first;
    if (i + 1 == a->count)
        return a->last;
    if (a->kind == AXIS_LOGARITHMIC)
        return round_digits(a, a->first * power(a->last / a->first, (double)i / last));
    return round_digits(a, (a->first * (last - (double)i) + a->last * (double)i) / last);
}

static const char *read_number(const char *text, double *value)
{
    char *end;
    if (isspace((unsigned char)text[0]))
        return NULL;
    *value = strtod(text, &end);
    return end != text && isfinite(*value) ? end : NULL;
}

/* Reads "N", at least 2; 1e7 is a whole number, too. */
static bool read_count(const char *text, uint64_t *count)
{
    char *end;
    const double number = strtod(text, &end);
    if (!isdigit((unsigned char)text[0]) || text[strspn(text, "0123456789e")] != '\0' || *end != '\0' ||
        !(number >= 2 && number <= (double)most_points))
        return false;
    *count = (uint64_t)number;
    return true;
}

/* Reads "A:B:N" or "A:B:log:N". */
static bool read_range(axis *a, const char *text)
{
    const char *end = read_number(text, &a->first);
    if (end == NULL || *end != ':')
        return false;
    end = read_number(end + 1, &a->last);
    if (end == NULL || *end != ':')
        return false;
    a->kind = strncmp(end, ":log:", 5) == 0 ? AXIS_LOGARITHMIC : AXIS_LINEAR;
    return read_count(end + (a->kind == AXIS_LOGARITHMIC ? 5 : 1), &a->count);
}

/* Reads "A,B,...". */
static bool read_list(axis *a, const char *text)
{
    size_t count = 1;
    for (const char *c = text; *c != '\0'; c++)
        count += *c == ',';
    a->kind = AXIS_LIST;
    a->list = calloc(count, sizeof *a->list);
    if (a->list == NULL)
        return false;
    for (a->count = 0; a->count < count; a->count++) {
        const char *end = read_number(text, &a->list[a->count]);
        if (end == NULL || *end != (a->count + 1 < count ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    return true;
}

static void list_parameters(const grid *g, char *text, size_t size)
{
    size_t used = 0;
    for (int p = 0; p < SWEEP_PARAMETERS; p++)
        if (sweep_has(g->scene, (sweep_parameter)p) && used < size)
            used += (size_t)snprintf(text + used, size - used, "%s%s", used > 0 ? ", " : "", sweep_parameters[p].name);
}

static bool find_parameter(grid *g, const char *text, sweep_parameter *found)
{
    const size_t length = strcspn(text, "=");
    for (int p = 0; p < SWEEP_PARAMETERS; p++) {
        const char *name = sweep_parameters[p].name;
        if (sweep_has(g->scene, (sweep_parameter)p) && strlen(name) == length && memcmp(name, text, length) == 0) {
            *found = (sweep_parameter)p;
            return true;
        }
    }
    char offered[300] = "";
    list_parameters(g, offered, sizeof offered);
    return refuse(g, "\"%.*s\" is not a parameter of %s %s; it should be one of %s", (int)length, text,
                  g->scene == SWEEP_SPRING ? "one" : "the scene", sweep_scene_name(g->scene), offered);
}

/* Checks that all values are within limits. Except in a list, they are between the first and the last value. */
static bool check_values(grid *g, const axis *a, const char *text)
{
    const sweep_parameter_info *p = &sweep_parameters[a->parameter];
    const uint64_t steps = a->kind == AXIS_LIST || p->whole ? a->count : 2;
    if (p->whole && (double)a->count > p->most)
        return refuse(g, "\"%s\" has more values than whole numbers up to %g", text, p->most);
    for (uint64_t k = 0; k < steps; k++) {
        const double value = axis_value(a, steps == a->count ? k : k * (a->count - 1));
        if (!(value >= p->least && value <= p->most))
            return refuse(g, "\"%s\" has the value %.17g; it should be from %g to %g", text, value, p->least, p->most);
        if (p->whole && value != rint(value))
            return refuse(g, "\"%s\" has the value %.17g; it should be a whole number", text, value);
    }
    return true;
}

static bool check_alone(grid *g, const axis *a, const char *text)
{
    for (size_t i = 0; i < g->axes; i++) {
        const sweep_parameter other = g->axis[i].parameter;
        if (other == a->parameter)
            return refuse(g, "\"%s\": \"%s\" is given already", text, sweep_parameters[other].name);
        if (sweep_parameters[other].instead == (int)a->parameter ||
            sweep_parameters[a->parameter].instead == (int)other)
            return refuse(g, "\"%s\": a sweep has either this parameter or \"%s\"", text, sweep_parameters[other].name);
    }
    return true;
}

static bool read_axis(grid *g, axis *a, const char *text)
{
    if (!find_parameter(g, text, &a->parameter))
        return false;
    const char *values = text + strcspn(text, "=");
    if (*values != '=' || !(strchr(values, ':') != NULL ? read_range(a, values + 1) : read_list(a, values + 1)))
        return refuse(
            g,
            "\"%s\" is not NAME=A:B:N, NAME=A:B:log:N or NAME=A,B,...; A and B should be finite numbers, and N a "
            "whole number of at least 2",
            text);
    if (a->kind == AXIS_LOGARITHMIC && !(a->first > 0 && a->last > 0))
        return refuse(g, "\"%s\": the ends of a logarithmic axis should be greater than 0", text);
    if (a->kind == AXIS_LOGARITHMIC && !isnormal(a->last / a->first))
        return refuse(g, "\"%s\": the ends are too far apart; their ratio should be a double", text);
    return check_values(g, a, text) && check_alone(g, a, text);
}

bool grid_add_axis(grid *g, const char *text)
{
    axis a = {.list = NULL};
    if (!read_axis(g, &a, text)) {
        free(a.list);
        return false;
    }
    g->axis[g->axes++] = a;
    return true;
}

/* ---------------------------------------------------------------------------------------------- methods, measures */

static bool offered(const grid *g, spring_method m)
{
    const spring_method_info *info = spring_method_describe(m);
    return g->scene == SWEEP_SPRING ? info->springs : info->scenes;
}

static bool is_word(const char *text, size_t length, const char *word)
{
    return strlen(word) == length && memcmp(text, word, length) == 0;
}

static bool add_method(grid *g, const char *name, size_t length)
{
    const bool all = is_word(name, length, "all");
    size_t found = 0;
    char names[200] = "all";
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method m = spring_method_at(i);
        if (!offered(g, m))
            continue;
        strcat(strcat(names, ", "), spring_method_name(m));
        if (!all && !is_word(name, length, spring_method_name(m)))
            continue;
        for (size_t k = 0; k < g->methods; k++)
            if (g->method[k] == m)
                return refuse(g, "\"%s\" is listed twice", spring_method_name(m));
        g->method[g->methods++] = m;
        found++;
    }
    return found > 0 || refuse(g, "\"%.*s\" is not one of %s", (int)length, name, names);
}

static bool add_measure(grid *g, const char *name, size_t length)
{
    char names[200] = "";
    for (int i = SWEEP_STEPS; i < SWEEP_MEASURES; i++) {
        const char *word = sweep_measure_names[i];
        strcat(strcat(names, i > SWEEP_STEPS ? ", " : ""), word);
        if (!is_word(name, length, word))
            continue;
        for (size_t k = 0; k < g->measures; k++)
            if (g->measure[k] == (sweep_measure)i)
                return refuse(g, "\"%s\" is listed twice", word);
        g->measure[g->measures++] = (sweep_measure)i;
        return true;
    }
    return refuse(g, "\"%.*s\" is not one of %s", (int)length, name, names);
}

static bool for_each(grid *g, const char *names, bool (*add)(grid *, const char *, size_t))
{
    for (;;) {
        const size_t length = strcspn(names, ",");
        if (!add(g, names, length))
            return false;
        if (names[length] == '\0')
            return true;
        names += length + 1;
    }
}

bool grid_add_methods(grid *g, const char *names)
{
    return for_each(g, names, add_method);
}

bool grid_add_measures(grid *g, const char *names)
{
    return for_each(g, names, add_measure);
}

/* ------------------------------------------------------------------------------------------------ points and blocks */

/* A scene takes about a thousand times as long as one spring. */
static uint64_t largest_block(const grid *g)
{
    return g->scene == SWEEP_SPRING ? 1024 : 16;
}

bool grid_finish(grid *g)
{
    g->points = 1;
    for (size_t i = 0; i < g->axes; i++) {
        if (g->axis[i].count > most_points / g->points)
            return refuse(g, "the grid has more than %" PRIu64 " points", most_points);
        g->points *= g->axis[i].count;
    }
    g->points_of_block = (g->points - 1) / most_blocks + 1;
    if (g->points_of_block > largest_block(g))
        g->points_of_block = largest_block(g);
    g->blocks = (g->points - 1) / g->points_of_block + 1;
    return true;
}

uint64_t grid_block_size(const grid *g, uint64_t block)
{
    const uint64_t left = g->points - block * g->points_of_block;
    return left < g->points_of_block ? left : g->points_of_block;
}

/* The parameters of a point; NaN for parameters without an axis. */
static void find_point(const grid *g, uint64_t point, double *value)
{
    for (int p = 0; p < SWEEP_PARAMETERS; p++)
        value[p] = NAN;
    for (size_t i = g->axes; i-- > 0;) {
        const axis *a = &g->axis[i];
        value[a->parameter] = axis_value(a, point % a->count);
        point /= a->count;
    }
}

bool grid_measure(const grid *g, sweep_memory *memory, uint64_t first, uint64_t count, double *values,
                  sweep_result *results)
{
    double value[SWEEP_PARAMETERS];
    for (uint64_t i = 0; i < count; i++) {
        find_point(g, first + i, value);
        for (size_t k = 0; k < g->axes; k++)
            *values++ = value[g->axis[k].parameter];
        for (size_t k = 0; k < g->methods; k++, results++) {
            sweep_measure_point(memory, g->scene, value, g->method[k], results);
            if (results->status == SWEEP_FAILED)
                return false;
        }
    }
    return true;
}
