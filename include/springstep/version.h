/* SPDX-License-Identifier: MIT */
/** @file
 * The version of springstep, written here and nowhere else (meson.build, CMakeLists.txt and packages read it), and the
 * mark of a public function.
 */
#ifndef SPRINGSTEP_VERSION_H
#define SPRINGSTEP_VERSION_H

/** What spring_version() says of the library that is linked. */
#define SPRING_VERSION "0.3.0"

/** Of the shared library: changes when programs that were compiled for the last release would not run any more. */
#define SPRING_SOVERSION "0.3"

/** @def SPRING_API
 * The mark of a public function: exported from a shared library. */
#if defined(_WIN32) && defined(SPRING_BUILD_DLL)
#define SPRING_API __declspec(dllexport)
#elif defined(_WIN32) && defined(SPRING_DLL) /* of a program that uses the DLL; without it calls take a detour */
#define SPRING_API __declspec(dllimport)
#elif defined(__GNUC__) && !defined(_WIN32)
#define SPRING_API __attribute__((visibility("default")))
#else
#define SPRING_API
#endif

#endif
