"""Wisp for Conan 2: what plays models, and with `-o "&:learn=True"` what learns them.

    conan create packaging/conan
"""

import re
from pathlib import Path

from conan import ConanFile
from conan.tools.build import check_min_cppstd
from conan.tools.cmake import CMake, CMakeDeps, CMakeToolchain, cmake_layout
from conan.tools.files import copy


class Wisp(ConanFile):
    name = "wisp"
    description = "Learns how a thing behaves from recordings and plays it live"
    license = "MIT"
    settings = "os", "compiler", "build_type", "arch"
    # shared: the C ABI as one shared library too. The layers themselves are static.
    options = {"shared": [True, False], "learn": [True, False]}
    default_options = {"shared": False, "learn": False}

    def _root(self):
        return Path(self.recipe_folder).resolve().parents[1]

    def set_version(self):
        self.version = re.search(r"VERSION ([\d.]+) LANG", (self._root() / "CMakeLists.txt").read_text())[1]

    def export_sources(self):
        for pattern in ("CMakeLists.txt", "LICENSE", "cmake/*", "include/*", "src/*", "third_party/*"):
            copy(self, pattern, src=str(self._root()), dst=self.export_sources_folder)

    def requirements(self):
        if self.options.learn:
            self.requires("eigen/3.4.0")
            self.requires("nlohmann_json/3.11.3")

    def validate(self):
        check_min_cppstd(self, 20)

    def layout(self):
        cmake_layout(self)

    def generate(self):
        toolchain = CMakeToolchain(self)
        toolchain.cache_variables.update({
            "BUILD_SHARED_LIBS": False,
            "WISP_BUILD_SHARED": bool(self.options.shared),
            "WISP_BUILD_LEARN": bool(self.options.learn),
            "WISP_BUILD_TESTS": False,
            "WISP_BUILD_APPS": False,
            "WISP_BUILD_MEDIA": False,
            "WISP_BUILD_MATFILE": False,
            "WISP_BUILD_SIMULATE": False,
        })
        toolchain.generate()
        CMakeDeps(self).generate()

    def build(self):
        cmake = CMake(self)
        cmake.configure()
        cmake.build()

    def package(self):
        CMake(self).install()
        for text in ("LICENSE", "third_party/NOTICES.txt", "third_party/flatbuffers/LICENSE"):
            copy(self, text, src=self.source_folder, dst=str(Path(self.package_folder) / "licenses"))

    def package_info(self):
        # find_package(wisp) finds Wisp's own package files; the rest is for builds without CMake, in the linker's order.
        self.cpp_info.set_property("cmake_find_mode", "none")
        self.cpp_info.builddirs = ["lib/cmake/wisp"]
        learning = ["wisp_c_learn", "wisp_learn", "wisp_record"] if self.options.learn else []
        self.cpp_info.libs = [*learning, "wisp_c", "wisp_run", "wisp_sound", "wisp_model", "wisp_base"]
