/* SPDX-License-Identifier: MIT */
/* The version of springstep, written here and nowhere else (meson.build reads it), and the mark of a public
   function. */
#ifndef SPRINGSTEP_VERSION_H
#define SPRINGSTEP_VERSION_H

#define SPRING_VERSION "0.1.0"

#if defined(_WIN32) && defined(SPRING_BUILDS_DLL)
#define SPRING_API __declspec(dllexport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define SPRING_API __attribute__((visibility("default")))
#else
#define SPRING_API
#endif

#endif
