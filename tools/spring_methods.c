/* SPDX-License-Identifier: MIT */
/* spring-methods: the methods of the library as a table, for programs that offer, compare or draw them. */
#include <springstep/spring.h>

#include "common/cli.h"

static const cli_option options[] = {{.name = NULL}};

static const cli_program program = {
    .name = "spring-methods",
    .summary = "List the methods of the library, in the order of tables and figures.",
    .columns = "method label order forces_per_step symplectic springs scenes",
    .meaning =
        "method is the name on a command line. label is the name in a text. order is 0 if there is no error\n"
        "except rounding error. symplectic (bounded energy error of smooth undamped motion), springs (available for\n"
        "one spring and batches) and scenes (available for scenes) are 1 or 0.",
    .shown = {"order", "forces_per_step"},
    .examples = {"", "-o methods.tsv", "| awk -F'\\t' '$7 == 1 {print $1}'"},
    .options = options,
};

int main(int argc, char **argv)
{
    cli_parse(&program, argc, argv);
    cli_table *table = cli_open_output();
    cli_columns(table, program.columns);
    for (int i = 0; i < SPRING_METHOD_COUNT; i++) {
        const spring_method_info *m = spring_method_describe(spring_method_at(i));
        cli_row(table, "%s\t%s\t%d\t%d\t%d\t%d\t%d", m->name, m->label, m->order, m->forces_per_step, m->symplectic,
                m->springs, m->scenes);
    }
    cli_finish();
    return 0;
}
