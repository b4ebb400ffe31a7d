# SPDX-License-Identifier: MIT
"""springstep as a package of Conan 2: conan create packaging/conan"""
import re
from pathlib import Path

from conan import ConanFile
from conan.tools.cmake import CMake, cmake_layout
from conan.tools.files import copy, load


class Springstep(ConanFile):
    name = "springstep"
    description = "Fast, deterministic spring simulation in C"
    license = "MIT"
    package_type = "library"
    languages = "C"
    settings = "os", "compiler", "build_type", "arch"
    options = {"shared": [True, False]}
    default_options = {"shared": False}
    generators = "CMakeToolchain"

    @property
    def _root(self):
        return Path(self.recipe_folder).parents[1]

    def set_version(self):
        header = load(self, self._root / "include/springstep/version.h")
        self.version = re.search(r'SPRING_VERSION "(.*)"', header)[1]

    def export_sources(self):
        for pattern in ["CMakeLists.txt", "meson.build", "LICENSE", "include/*", "src/*"]:
            copy(self, pattern, self._root, self.export_sources_folder)

    def layout(self):
        cmake_layout(self)

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        source, build, package = map(Path, [self.source_folder, self.build_folder, self.package_folder])
        copy(self, "LICENSE", source, package / "licenses")
        copy(self, "*.h", source / "include", package / "include")
        for pattern in ["*.a", "*.lib", "*.so*", "*.dylib"]:
            copy(self, pattern, build, package / "lib", keep_path=False)
        copy(self, "*.dll", build, package / "bin", keep_path=False)

    def package_info(self):
        self.cpp_info.libs = ["springstep"]
        if self.settings.os != "Windows":
            self.cpp_info.system_libs = ["m"]
        elif self.options.shared:
            self.cpp_info.defines = ["SPRING_DLL"]
