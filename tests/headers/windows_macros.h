/* SPDX-License-Identifier: MIT */
/* Words that windows.h of Microsoft's SDK and of mingw-w64 defines as macros (minwindef.h, rpcndr.h, basetyps.h, wingdi.h,
   winnt.h), for compilers of other systems. springstep.c compiles after these definitions. */
#define near
#define far
#define pascal
#define cdecl
#define small     char
#define hyper     long long
#define interface struct
#define min(a, b) (((a) < (b)) ? (a) : (b))
#define max(a, b) (((a) > (b)) ? (a) : (b))
#define IN
#define OUT
#define OPTIONAL
#define NEAR
#define FAR
#define CONST const
#define VOID  void
#define THIS  void *This
#define PURE
#define STRICT      1
#define ERROR       0
#define IGNORE      0
#define ABSOLUTE    1
#define RELATIVE    2
#define ALTERNATE   1
#define WINDING     2
#define OPAQUE      2
#define PLANES      14
#define INFINITE    0xffffffff
#define DELETE      0x00010000
#define TEXT(quote) L##quote
