# SPDX-License-Identifier: MIT
# A CMake project that fetches the library and builds it with its own sources.
cmake_minimum_required(VERSION 3.14)
project(app C CXX)
set(CMAKE_CXX_STANDARD 11)
include(FetchContent)
FetchContent_Declare(springstep GIT_REPOSITORY https://example.org/springstep.git GIT_TAG main)
FetchContent_MakeAvailable(springstep)
add_executable(app-c app.c)
add_executable(app-cxx app.cpp)
target_link_libraries(app-c PRIVATE springstep::springstep)
target_link_libraries(app-cxx PRIVATE springstep::springstep)
