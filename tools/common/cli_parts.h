/* SPDX-License-Identifier: MIT */
/* What the files behind cli.h share. One tool is one process: there is one command line. */
#ifndef SPRINGSTEP_CLI_PARTS_H
#define SPRINGSTEP_CLI_PARTS_H

#include <stdio.h>
#include <time.h>

#include "common/cli.h"

typedef struct cli_command {
    const cli_program *program;
    time_t started;
    const char *output; /* what --output names; NULL: standard output */
    char *text;         /* for the stamp: the options as they were understood */
} cli_command;

extern cli_command cli_asked;

/* cli.c */

/** Those of the tool, then those that every tool has; NULL behind the last one. */
const cli_option *cli_option_at(size_t i);

/** What option i does where it is not given, as text; "": the table does not say. */
const char *cli_default(size_t i);

/** What the value of an option should be: "a finite number". */
void cli_print_expectation(FILE *out, const cli_option *o);

/** The words that the value of an option is one of, if it is one of some. */
void cli_print_words(FILE *out, const cli_option *o, const char *separator);

/* cli_help.c: on standard output */

void cli_print_help(void);
void cli_print_man(void);
void cli_print_completion(void);

/* cli_output.c */

/** If all goes on as what is done: ", 12 s left", ", 3 min left". The clock ticks in seconds: the first says nothing.
    @param spent  [s] */
void cli_describe_time_left(char *text, size_t size, double fraction, double spent);

/** From now on nothing but complete files is left, whatever ends the program. */
void cli_guard_files(void);

/** Close standard output, and end the program: with status 0 if all of it could be written. */
_Noreturn void cli_finish_text(void);

#endif
