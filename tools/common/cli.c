/* SPDX-License-Identifier: MIT */
/*
 * The command line of a tool: strict numbers, words, options from a table; see cli.h.
 *
 * getopt_long() is not used because it always accepts abbreviations of long options. A script with the abbreviation
 * --step could change its meaning when an option is added.
 */
#define _XOPEN_SOURCE 700 /* open_memstream() */
#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/cli_parts.h"

cli_command cli_asked;

/* ------------------------------------------------------------------------------------------------------ numbers */

static bool parse_count(const char *text, uint64_t *value)
{
    if (!isdigit((unsigned char)text[0]))
        return false;
    char *end;
    errno = 0;
    unsigned long long mantissa = strtoull(text, &end, 10);
    const bool power = *end == 'e' && isdigit((unsigned char)end[1]);
    const unsigned long long exponent = power ? strtoull(end + 1, &end, 10) : 0;
    if (errno != 0 || *end != '\0' || exponent > 19)
        return false;
    for (unsigned i = 0; i < exponent; i++) {
        if (mantissa > UINT64_MAX / 10)
            return false;
        mantissa *= 10;
    }
    *value = mantissa;
    return true;
}

/* Returns a pointer past the number; NULL: there is no number. */
static const char *read_real(const char *text, double *value)
{
    char *end;
    errno = 0;
    *value = strtod(text, &end);
    const bool vanished = errno == ERANGE && *value == 0;
    return end != text && !isspace((unsigned char)text[0]) && isfinite(*value) && !vanished ? end : NULL;
}

static bool parse_real(const char *text, double *value)
{
    const char *end = read_real(text, value);
    return end != NULL && *end == '\0';
}

/* Reads `count` numbers separated by commas. Leaves `values` unchanged on failure. */
static bool parse_reals(const char *text, double *values, size_t count)
{
    double parsed[8];
    assert(count <= sizeof parsed / sizeof parsed[0]); /* no option has more */
    for (size_t i = 0; i < count; i++) {
        const char *end = read_real(text, &parsed[i]);
        if (end == NULL || *end != (i + 1 < count ? ',' : '\0'))
            return false;
        text = end + 1;
    }
    memcpy(values, parsed, count * sizeof parsed[0]);
    return true;
}

/* -------------------------------------------------------------------------------------------------------- words */

bool cli_for_springs(const spring_method_info *method)
{
    return method->springs;
}

bool cli_for_steps(const spring_method_info *method)
{
    return method->springs && method->order > 0;
}

bool cli_for_scenes(const spring_method_info *method)
{
    return method->scenes;
}

void cli_list_methods(char *text, size_t size, bool (*offers)(const spring_method_info *method))
{
    size_t length = 0;
    text[0] = '\0';
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method_info *info = spring_method_describe(spring_method_at(i));
        if (offers(info) && length < size)
            length += (size_t)snprintf(text + length, size - length, "%s%s", length > 0 ? ", " : "", info->name);
    }
}

/* Returns the i-th valid word of an option and stores its value; NULL: there are no more. */
static const char *word_of(const cli_option *o, int i, int *value)
{
    *value = i;
    if (o->kind == CLI_CHOICE)
        return o->choices[i];
    for (int k = 0; o->kind == CLI_METHOD && k < SPRING_METHOD_COUNT; k++) {
        *value = (int)spring_method_at(k);
        const spring_method_info *info = spring_method_describe(spring_method_at(k));
        if (o->offers(info) && i-- == 0)
            return info->name;
    }
    return NULL;
}

const char *cli_word_list(const cli_option *o, const char *separator)
{
    static char text[8192];
    size_t length = 0;
    const char *word;
    text[0] = '\0';
    for (int i = 0, value; (word = word_of(o, i, &value)) != NULL && length < sizeof text; i++)
        length += (size_t)snprintf(text + length, sizeof text - length, "%s%s", i > 0 ? separator : "", word);
    return text;
}

static bool parse_word(const char *text, const cli_option *o)
{
    const char *word;
    int value;
    for (int i = 0; (word = word_of(o, i, &value)) != NULL; i++) {
        if (strcmp(text, word) == 0) {
            *o->choice = value;
            return true;
        }
    }
    return false;
}

/* -------------------------------------------------------------------------------------------------- did you mean */

enum { LONGEST_WORD = 40 }; /* longer words get no suggestion */

static size_t least_of(size_t a, size_t b)
{
    return a < b ? a : b;
}

/* The edit distance of two words: the least number of substitutions, insertions, deletions and exchanges of adjacent
   letters. d[i][j] is the distance of the first i letters of `a` and the first j letters of `b`. */
static size_t distance(const char *a, const char *b)
{
    const size_t m = strlen(a), n = strlen(b);
    size_t d[LONGEST_WORD + 1][LONGEST_WORD + 1];
    if (m > LONGEST_WORD || n > LONGEST_WORD)
        return SIZE_MAX;
    for (size_t i = 0; i <= m; i++)
        for (size_t j = 0; j <= n; j++) {
            d[i][j] = i + j;
            if (i == 0 || j == 0)
                continue;
            const bool same = tolower((unsigned char)a[i - 1]) == tolower((unsigned char)b[j - 1]);
            d[i][j] = least_of(least_of(d[i - 1][j], d[i][j - 1]) + 1, d[i - 1][j - 1] + !same);
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                d[i][j] = least_of(d[i][j], d[i - 2][j - 2] + 1);
        }
    return d[m][n];
}

/* The word most similar to the typed one. A third of its letters may be wrong, or the typed word may be a prefix. */
typedef struct likeness {
    const char *typed, *word; /* NULL: none is similar */
    size_t distance;
} likeness;

static void compare(likeness *best, const char *word)
{
    const size_t allowed = (strlen(word) + 1) / 3, begun = strlen(best->typed), enough = 3;
    size_t d = distance(best->typed, word);
    if (begun >= enough && strncmp(best->typed, word, begun) == 0)
        d = least_of(d, allowed);
    if (d <= allowed && (best->word == NULL || d < best->distance)) {
        best->word = word;
        best->distance = d;
    }
}

/* ------------------------------------------------------------------------------------------------------ options */

static bool want_help, want_version, want_man, want_completion;

static const cli_option common_options[] = {
    {"output", CLI_FILE, .file = &cli_asked.output, .value = "FILE",
     .help = "write to FILE instead of standard output\n"
             "FILE is created or replaced when the output is complete."},
    {"help", CLI_FLAG, .flag = &want_help, .help = "print the options and some examples, and exit"},
    {"version", CLI_FLAG, .flag = &want_version, .help = "print the version, and exit"},
    {.name = NULL},
};

/* Used by the installation. */
static const cli_option hidden_options[] = {
    {"man", CLI_FLAG, .flag = &want_man},
    {"completion", CLI_FLAG, .flag = &want_completion},
    {.name = NULL},
};

/* All options: of the tool, common, and hidden. */
static struct {
    const cli_option *option;
    bool given;
    char standard[32]; /* the default as text */
} option_table[64];
static size_t option_count, shown_count; /* all but the hidden ones are shown */

const cli_option *cli_option_at(size_t i)
{
    return i < shown_count ? option_table[i].option : NULL;
}

const char *cli_default(size_t i)
{
    return option_table[i].standard;
}

bool cli_given(const void *target)
{
    for (size_t i = 0; i < shown_count; i++)
        if (option_table[i].option->flag == target)
            return option_table[i].given;
    return false;
}

const char *cli_expectation(const cli_option *o)
{
    static char text[8300];
    switch (o->kind) {
    case CLI_FLAG:
        return "";
    case CLI_COUNT:
        if (o->most > 0)
            snprintf(text, sizeof text, "a whole number from %" PRIu64 " to %" PRIu64, o->least, o->most);
        else
            snprintf(text, sizeof text, "a whole number of at least %" PRIu64, o->least);
        return text;
    case CLI_REAL:
        return "a finite number";
    case CLI_NOT_NEGATIVE:
        return "a finite number of at least 0";
    case CLI_POSITIVE:
        return "a finite number greater than 0";
    case CLI_CHOICE:
    case CLI_METHOD:
        snprintf(text, sizeof text, "one of %s", cli_word_list(o, ", "));
        return text;
    case CLI_REALS:
        snprintf(text, sizeof text, "%" PRIu64 " finite numbers separated by commas, %s", o->least, o->value);
        return text;
    case CLI_FILE:
    case CLI_INPUT:
        return "the name of a file";
    case CLI_FOLDER:
        return "the name of a folder";
    case CLI_WORDS:
        return o->value;
    }
    return "";
}

/* The initial value of a target is the default, if it is a valid value of the option. */
static void note_default(char *text, size_t size, const cli_option *o)
{
    text[0] = '\0';
    const bool real = o->kind == CLI_REAL || (o->kind == CLI_NOT_NEGATIVE && *o->real >= 0) ||
                      (o->kind == CLI_POSITIVE && *o->real > 0);
    if (o->required)
        return;
    if (real && isfinite(*o->real))
        snprintf(text, size, "%g", *o->real);
    else if (o->kind == CLI_COUNT && *o->count >= o->least)
        snprintf(text, size, "%" PRIu64, *o->count);
    else if (o->kind == CLI_CHOICE && *o->choice >= 0)
        snprintf(text, size, "%s", o->choices[*o->choice]);
    else if (o->kind == CLI_METHOD && *o->choice >= 0)
        snprintf(text, size, "%s", spring_method_name((spring_method)*o->choice));
}

/* The options that are defined by a table. The initial values of their targets are their defaults. */
static void add_options(const cli_option *options)
{
    for (const cli_option *o = options; o->name != NULL; o++) {
        assert(option_count < sizeof option_table / sizeof option_table[0]);
        note_default(option_table[option_count].standard, sizeof option_table[option_count].standard, o);
        option_table[option_count++].option = o;
    }
}

/* ------------------------------------------------------------------------------------------------------- parsing */

/* "program: --option: problem what it should be" */
static _Noreturn void fail_at(const cli_option *o, const char *value, const char *problem)
{
    likeness best = {.typed = value != NULL ? value : ""};
    const char *word;
    for (int i = 0, which; (word = word_of(o, i, &which)) != NULL; i++)
        compare(&best, word);
    const bool known = value != NULL, meant = best.word != NULL;
    cli_fail(CLI_USAGE, "--%s: %s%s%s%s%s%s%s%s", o->name, known ? "\"" : "", known ? value : "", known ? "\" " : "",
             problem, cli_expectation(o), meant ? "; did you mean \"" : "", meant ? best.word : "", meant ? "\"?" : "");
}

static _Noreturn void fail_as_no_option(const char *word)
{
    char name[LONGEST_WORD + 1] = "";
    const char *start = word + strspn(word, "-");
    const size_t length = strcspn(start, "=");
    if (length <= LONGEST_WORD)
        memcpy(name, start, length);
    likeness best = {.typed = name};
    for (size_t i = 0; cli_option_at(i) != NULL; i++)
        compare(&best, cli_option_at(i)->name);
    cli_fail(CLI_USAGE, "\"%s\" is not an option; %s%s%ssee %s --help", word,
             best.word != NULL ? "did you mean --" : "", best.word != NULL ? best.word : "",
             best.word != NULL ? "? " : "", cli_asked.program->name);
}

static bool add_word(cli_words *words, const char *word)
{
    const char **more = realloc(words->word, (words->count + 1) * sizeof *more);
    if (more == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    words->word = more;
    words->word[words->count++] = word;
    return word[0] != '\0';
}

static bool store(const cli_option *o, const char *value)
{
    switch (o->kind) {
    case CLI_FLAG:
        break;
    case CLI_COUNT:
        return parse_count(value, o->count) && *o->count >= o->least && (o->most == 0 || *o->count <= o->most);
    case CLI_REAL:
        return parse_real(value, o->real);
    case CLI_NOT_NEGATIVE:
        return parse_real(value, o->real) && *o->real >= 0;
    case CLI_POSITIVE:
        return parse_real(value, o->real) && *o->real > 0;
    case CLI_CHOICE:
    case CLI_METHOD:
        return parse_word(value, o);
    case CLI_REALS:
        return parse_reals(value, o->real + (o->times != NULL ? *o->times * o->least : 0), o->least);
    case CLI_FILE:
    case CLI_INPUT:
    case CLI_FOLDER:
        *o->file = value;
        return value[0] != '\0';
    case CLI_WORDS:
        return add_word(o->words, value);
    }
    return false;
}

/* The index of the option with this name; option_count: there is none. */
static size_t find_option(const char *name, size_t length)
{
    size_t i = 0;
    while (i < option_count &&
           (strlen(option_table[i].option->name) != length || strncmp(option_table[i].option->name, name, length) != 0))
        i++;
    return i;
}

static size_t option_of(const char *word, const char **value)
{
    *value = NULL;
    if (strcmp(word, "-h") == 0)
        return find_option("help", strlen("help"));
    /* -out... is a long option with one dash missing, not -o with the value "ut..." */
    if (word[0] == '-' && word[1] == 'o' && word[2] != '=' && strncmp(word, "-out", 4) != 0) {
        if (word[2] != '\0')
            *value = word + 2;
        return find_option("output", strlen("output"));
    }
    if (word[0] != '-' || word[1] != '-')
        return option_count;
    const size_t length = strcspn(word + 2, "=");
    if (word[2 + length] == '=')
        *value = word + 2 + length + 1;
    return find_option(word + 2, length);
}

/* Prints a word quoted for a shell, on one line: control characters become "?". Only words with special characters are
   quoted. */
static void print_quoted(FILE *out, const char *word)
{
    static const char plain[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
    if (word[0] != '\0' && word[strspn(word, plain)] == '\0') {
        fputs(word, out);
        return;
    }
    fputc('\'', out);
    for (; *word != '\0'; word++)
        if (*word == '\'')
            fputs("'\\''", out);
        else
            fputc(iscntrl((unsigned char)*word) ? '?' : *word, out);
    fputc('\'', out);
}

/* The stamp must not depend on where the output goes. So it omits --output, and contains only the presence of options
   that name other output files. */
static void record(FILE *words, const cli_option *o, const char *value)
{
    if (o->file == &cli_asked.output || o->unstamped)
        return;
    fprintf(words, " --%s", o->name);
    if (o->kind == CLI_FLAG)
        return;
    fputc(' ', words);
    print_quoted(words, o->kind == CLI_FILE || o->kind == CLI_FOLDER ? o->value : value);
}

static void print_and_exit_if_wanted(void)
{
    if (want_help)
        cli_print_help();
    else if (want_version)
        printf("%s (springstep) %s\n", cli_asked.program->name, spring_version());
    else if (want_man)
        cli_print_man();
    else if (want_completion)
        cli_print_completion();
    else
        return;
    cli_finish_text();
}

static void take_value(const cli_option *o, const char *value)
{
    if (value == NULL)
        fail_at(o, NULL, "the value is missing; it should be ");
    if (o->times != NULL && *o->times == o->most)
        cli_fail(CLI_USAGE, "--%s: \"%s\" is one too many; it can be given at most %" PRIu64 " times", o->name, value,
                 o->most);
    if (!store(o, value))
        fail_at(o, value, "is not ");
    if (o->times != NULL)
        ++*o->times;
}

static void check_options(void)
{
    for (size_t i = 0; i < shown_count; i++)
        if (option_table[i].option->required && !option_table[i].given)
            fail_at(option_table[i].option, NULL, "is missing; it should be ");
    for (size_t i = 0; i < shown_count; i++) {
        const void *const needs = option_table[i].option->needs;
        if (needs == NULL || !option_table[i].given || cli_given(needs))
            continue;
        for (size_t k = 0; k < shown_count; k++)
            if (option_table[k].option->flag == needs)
                cli_fail(CLI_USAGE, "--%s: has no effect without --%s", option_table[i].option->name,
                         option_table[k].option->name);
    }
}

void cli_parse(const cli_program *p, int argc, char **argv)
{
    cli_asked.program = p;
    cli_asked.started = time(NULL);
    cli_guard_files();
    add_options(p->options);
    add_options(common_options);
    shown_count = option_count;
    add_options(hidden_options);
    size_t length;
    FILE *words = open_memstream(&cli_asked.text, &length);
    if (words == NULL)
        cli_fail(CLI_FAILED, "out of memory");
    fputs(p->name, words);
    for (int i = 1; i < argc; i++) {
        const char *value;
        const size_t which = option_of(argv[i], &value);
        if (which == option_count)
            fail_as_no_option(argv[i]);
        const cli_option *const o = option_table[which].option;
        option_table[which].given = true;
        if (o->kind == CLI_FLAG) {
            if (value != NULL)
                cli_fail(CLI_USAGE, "--%s: \"%s\" is not expected: this option takes no value", o->name, value);
            *o->flag = true;
            print_and_exit_if_wanted();
        } else {
            if (value == NULL && i + 1 < argc)
                value = argv[++i];
            take_value(o, value);
        }
        record(words, o, value);
        while (o->kind == CLI_WORDS && i + 1 < argc && argv[i + 1][0] != '-') {
            take_value(o, argv[++i]);
            record(words, o, argv[i]);
        }
    }
    if (fclose(words) != 0)
        cli_fail(CLI_FAILED, "out of memory");
    check_options();
}
