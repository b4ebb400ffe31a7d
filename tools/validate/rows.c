/* SPDX-License-Identifier: MIT */
/* The table of spring-validate; see rows.h. */
#include "rows.h"

static cli_table *table;
static unsigned failures;

void validate_into(cli_table *rows)
{
    table = rows;
}

void validate_check(const validate_row *r)
{
    const bool pass = r->error <= r->bound; /* false for NaN */
    failures += !pass;
    cli_row(table, "%s\t%s\t%s\t%.17g\t%" PRIu64 "\t%.17g\t%.17g\t%s\t%s\t%.17g\t%" PRIu64 "\t%s", r->of, r->method,
            r->reference, r->dt, r->steps, r->error, r->bound, pass ? "pass" : "fail", r->reason, r->uncertainty,
            r->evaluations, r->scene ? "scene" : "spring");
}

unsigned validate_failures(void)
{
    return failures;
}
