/* SPDX-License-Identifier: MIT */
/*
 * malloc() and free() of the WebAssembly module: a list of free blocks in the order of their addresses, of which the first
 * that is large enough is used. Scenes are few and large. The functions of wasi-libc are 9 kB.
 */
#ifndef SPRINGSTEP_WASM_MEMORY_H
#define SPRINGSTEP_WASM_MEMORY_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* What precedes the bytes of a block. */
typedef struct block {
    size_t bytes;       /* with this header, a multiple of its size */
    struct block *next; /* of a free block: the next one */
} block;

enum { page = 1 << 16 }; /* [bytes] by which memory of WebAssembly grows */

static block *free_blocks;

static block *end_of(block *b)
{
    return b + b->bytes / sizeof *b;
}

/* Appends the next free block to b if it begins where b ends. */
static void join(block *b)
{
    if (b->next != NULL && end_of(b) == b->next) {
        b->bytes += b->next->bytes;
        b->next = b->next->next;
    }
}

EXPORT(free) void give_back(void *memory)
{
    if (memory == NULL)
        return;
    block *const b = (block *)memory - 1, *before = NULL;
    block **link = &free_blocks;
    while (*link != NULL && *link < b) {
        before = *link;
        link = &before->next;
    }
    b->next = *link;
    *link = b;
    join(b);
    if (before != NULL)
        join(before);
}

/* Adds memory for a block to the list; false: the engine has none. */
static bool grow(size_t bytes)
{
    const size_t pages = (bytes - 1) / page + 1;
    const size_t first = __builtin_wasm_memory_grow(0, pages);
    if (first == SIZE_MAX)
        return false;
    block *const b = (block *)(first * page);
    b->bytes = pages * page;
    give_back(b + 1);
    return true;
}

/* Aligned to 8 bytes; NULL: no memory. */
EXPORT(malloc) void *take(size_t bytes)
{
    if (bytes > SIZE_MAX - page)
        return NULL;
    bytes = (bytes / sizeof(block) + 2) * sizeof(block);
    do
        for (block **link = &free_blocks; *link != NULL; link = &(*link)->next) {
            block *const b = *link;
            if (b->bytes < bytes)
                continue;
            b->bytes -= bytes; /* the rest stays free */
            if (b->bytes == 0)
                *link = b->next;
            block *const taken = end_of(b);
            taken->bytes = bytes;
            return taken + 1;
        }
    while (grow(bytes));
    return NULL;
}

static void *take_zeros(size_t count, size_t bytes)
{
    void *const memory = count <= SIZE_MAX / bytes ? take(count * bytes) : NULL;
    if (memory != NULL)
        memset(memory, 0, count * bytes);
    return memory;
}

#endif
