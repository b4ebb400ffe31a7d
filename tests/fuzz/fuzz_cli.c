/* SPDX-License-Identifier: MIT */
/*
 * Arbitrary bytes as a word of the command line. Numbers are read strictly, with the same values as strtod(). The
 * common source of the tools is included, to access its static functions.
 */
#include "../../tools/common/cli.c"
#include "../../tools/common/cli_help.c"
#include "../../tools/common/cli_output.c"

#include <float.h>

#include "fuzz.h"

static uint64_t whole;
static double number, numbers[3];
static int choice;
static const char *file;
static bool flag;

static const cli_option options[] = {
    {"count", CLI_COUNT, .count = &whole, .least = 1, .most = UINT64_C(10000000000)},
    {"real", CLI_REAL, .real = &number},
    {"not-negative", CLI_NOT_NEGATIVE, .real = &number},
    {"positive", CLI_POSITIVE, .real = &number},
    {"method", CLI_METHOD, .choice = &choice, .offers = cli_for_springs},
    {"reals", CLI_REALS, .real = numbers, .least = 3},
    {"file", CLI_FILE, .file = &file},
    {"folder", CLI_FOLDER, .file = &file},
    {"flag", CLI_FLAG, .flag = &flag},
    {.name = NULL},
};
static const cli_program fuzzed = {.name = "fuzz_cli", .options = options};

static void must_read(bool holds, const char *what, const char *word)
{
    if (holds)
        return;
    fprintf(stderr, "fuzz_cli: %s: \"%s\"\n", what, word);
    abort();
}

/* Digits, or digits e digits. */
static bool looks_whole(const char *word)
{
    const size_t digits = strspn(word, "0123456789");
    const char *rest = word + digits;
    if (digits == 0 || *rest == '\0')
        return digits > 0;
    const size_t exponent = strspn(rest + 1, "0123456789");
    return *rest == 'e' && exponent > 0 && exponent < 3 && rest[1 + exponent] == '\0' && atoi(rest + 1) < 20;
}

static void check_count(const char *word)
{
    const uint64_t untouched = 42;
    uint64_t value = untouched;
    const bool accepted = parse_count(word, &value);
    const double other = strtod(word, NULL);
    if (accepted) {
        must_read(strspn(word, "0123456789e") == strlen(word), "digits, and e for the power of ten", word);
        must_read(fabs((double)value - other) <= DBL_EPSILON * other, "the value is another one", word);
    } else {
        must_read(value == untouched, "a count that is refused changes nothing", word);
        must_read(!looks_whole(word) || other > 0x1p64 * (1 - DBL_EPSILON), "a whole number is refused", word);
    }
}

static void check_real(const char *word)
{
    double value = NAN;
    char *end;
    const double other = strtod(word, &end);
    const bool finite = end != word && *end == '\0' && isfinite(other) && strchr(" \t\n\v\f\r", word[0]) == NULL;
    if (parse_real(word, &value)) {
        must_read(finite, "more than a number", word);
        must_read(value == other, "the value is another one", word);
    } else {
        must_read(!finite || other == 0, "a number is refused; only 0 may stand for one that vanished", word);
    }
}

static void check_values(const char *word)
{
    for (const cli_option *o = options; o->name != NULL; o++) {
        if (o->kind == CLI_FLAG || !store(o, word))
            continue;
        must_read(o->kind != CLI_COUNT || (whole >= o->least && whole <= o->most), "a count beyond its limits", word);
        must_read(o->kind != CLI_NOT_NEGATIVE || number >= 0, "a negative number", word);
        must_read(o->kind != CLI_POSITIVE || number > 0, "not a positive number", word);
        must_read(o->kind != CLI_METHOD || strcmp(word, spring_method_name((spring_method)choice)) == 0,
                  "another method", word);
        must_read((o->kind != CLI_FILE && o->kind != CLI_FOLDER) || *word != '\0', "no name", word);
    }
    const char *value;
    if (option_count == 0) {
        add_options(options);
        add_options(common_options);
    }
    const size_t which = option_of(word, &value);
    const cli_option *o = which < option_count ? option_table[which].option : NULL;
    must_read(o != NULL || word[0] != '-' || word[1] != 'o', "-o is always an option", word);
    must_read(value == NULL || (value > word && value <= word + strlen(word)), "the value is part of the word", word);
    if (o != NULL && word[1] == '-')
        must_read(strncmp(word + 2, o->name, strlen(o->name)) == 0, "names are not abbreviated", word);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char word[512];
    if (size >= sizeof word)
        return 0;
    memcpy(word, data, size);
    word[size] = '\0';
    cli_asked.program = &fuzzed;
    check_count(word);
    check_real(word);
    check_values(word);
    return 0;
}
