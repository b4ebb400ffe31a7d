/* SPDX-License-Identifier: MIT */
/*
 * A part of a sweep is a file, and the file is the journal of its work: a header, then the rows of one block after the
 * other, each ended by a line
 *
 *     # block K CRC
 *
 * that is written with them. So who is killed loses no more than the block at work; what is torn or damaged is seen by
 * the CRC; and who comes next goes on behind the last whole block. Blocks are in their order, first, first + every, ...
 *
 * Nothing here prints or ends the program. A function that fails leaves a message.
 */
#ifndef SPRINGSTEP_SWEEP_JOURNAL_H
#define SPRINGSTEP_SWEEP_JOURNAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct journal journal;

/* What is wrong; it names the file. */
extern char journal_message[1000];

/**
 * Open the file of a part, or make it. It is locked until journal_close().
 *
 * @param header  lines that the file has to start with
 * @return NULL: it is in use, is not this part's, or cannot be read or written
 */
journal *journal_open(const char *path, const char *header, uint64_t first, uint64_t every, uint64_t blocks);

/** Is there no such file, or one that starts with the header, as far as it goes? Nothing is written or locked. */
bool journal_fits(const char *path, const char *header);

/** Was the file found damaged, before blocks that are whole? Then these are kept, and the others are done again. */
bool journal_damaged(const journal *j);

/** Is the block there? Blocks are asked for in their order, and one that is not there is added before the next. */
bool journal_has(journal *j, uint64_t block, bool *there);
bool journal_add(journal *j, uint64_t block, const char *rows, size_t length);

/** All are there. Fails if the file was moved, replaced or removed; a file that was removed is written again first. May be
    called with NULL, and after a failure. */
bool journal_close(journal *j);

/* --------------------------------------------------------------------------------------------------------- reading */

/* Whole parts are read block by block, one file open at a time: there may be more parts than files that may be open. */
typedef struct journal_reader {
    const char *path;
    long long offset; /* of the next block */
} journal_reader;

/** The header of a file, up to its first line that does not start with "#", that line included; released by free().
    NULL: cannot be read, or there is no such line. */
char *journal_header(const char *path, journal_reader *reader);

/** The rows of a block, which should be the next one; released by free(). NULL: it is not there, torn or damaged. */
char *journal_read(journal_reader *reader, uint64_t block, size_t *length);

/** Is there nothing behind the last block that was read? */
bool journal_ends(const journal_reader *reader);

#endif
