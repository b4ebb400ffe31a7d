/* SPDX-License-Identifier: MIT */
/** @file
 * The version of springstep, and the macro SPRING_API, which marks public functions. The version is defined only here.
 * meson.build, CMakeLists.txt and packages read it.
 */
#ifndef SPRINGSTEP_VERSION_H
#define SPRINGSTEP_VERSION_H

/** The version of these headers. spring_version() returns the version of the linked library. */
#define SPRING_VERSION "0.4.0"

/** The binary interface of the shared library. It changes when programs compiled for the last release would no longer
   run. */
#define SPRING_SOVERSION "0.4"

/** @def SPRING_API
 * Marks a public function, which a shared library exports. Define SPRING_HIDDEN to hide the two files inside a shared
 * library of your own. */
#if defined(_WIN32) && defined(SPRING_BUILD_DLL)
#define SPRING_API __declspec(dllexport)
#elif defined(_WIN32) && defined(SPRING_DLL) /* for programs that use the DLL; optional, avoids an indirect call */
#define SPRING_API __declspec(dllimport)
#elif defined(__GNUC__) && !defined(_WIN32) && defined(SPRING_HIDDEN)
#define SPRING_API __attribute__((visibility("hidden")))
#elif defined(__GNUC__) && !defined(_WIN32)
#define SPRING_API __attribute__((visibility("default")))
#else
#define SPRING_API
#endif

#endif
