/* SPDX-License-Identifier: MIT */
/* Internal declarations of the files behind cli.h. A process has one command line, so its state is global. */
#ifndef SPRINGSTEP_CLI_PARTS_H
#define SPRINGSTEP_CLI_PARTS_H

#include <stdio.h>
#include <time.h>

#include "common/cli.h"

typedef struct cli_command {
    const cli_program *program;
    time_t started;
    const char *output; /* the value of --output; NULL: standard output */
    char *text;         /* the parsed options, for the stamp */
} cli_command;

extern cli_command cli_asked;

/* cli.c */

/** Option i: the options of the tool come first, then the common options; NULL after the last. */
const cli_option *cli_option_at(size_t i);

/** The default of option i as text; "": it has none. */
const char *cli_default(size_t i);

/** Describes valid values: "a finite number". */
const char *cli_expectation(const cli_option *o);

/** The valid words of an option, if it has a list of them. */
const char *cli_word_list(const cli_option *o, const char *separator);

/* cli_help.c; prints to standard output */

void cli_print_help(void);
void cli_print_man(void);
void cli_print_completion(void);

/* cli_output.c */

/** The remaining time, extrapolated from the time spent: ", 12 s left", ", 3 min left". Empty for the first 2 seconds,
    because the clock has a resolution of 1 s.
    @param spent  [s] */
void cli_describe_time_left(char *text, size_t size, double fraction, double spent);

/** Removes temporary files when the program ends, by exit() or by a signal. */
void cli_guard_files(void);

/** Close standard output and exit, with status 0 if all output could be written. */
_Noreturn void cli_finish_text(void);

#endif
