# SPDX-License-Identifier: MIT
# A CMake project that fetches the library and builds it with its own sources.
cmake_minimum_required(VERSION 3.14)
project(app C)
include(FetchContent)
FetchContent_Declare(springstep GIT_REPOSITORY https://example.org/springstep.git GIT_TAG main)
FetchContent_MakeAvailable(springstep)
add_executable(app-c app.c)
target_link_libraries(app-c PRIVATE springstep::springstep)
if(NOT WIN32) # mingw-w64's C++ compiler is a package of its own
  enable_language(CXX)
  set(CMAKE_CXX_STANDARD 11)
  add_executable(app-cxx app.cpp)
  target_link_libraries(app-cxx PRIVATE springstep::springstep)
endif()
