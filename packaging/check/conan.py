"""Packs Wisp by its recipe for Conan where Conan is not: what the recipe calls is played here, by Conan 2's documentation.

    conan.py ROOT WORK [learn] [shared]        the package: WORK/package; prints where its CMake files lie
"""

import importlib.util
import pathlib
import shutil
import subprocess
import sys
import types

root, work = (pathlib.Path(given).resolve() for given in sys.argv[1:3])


class CppInfo(types.SimpleNamespace):
    def set_property(self, name, value):
        self.__dict__.setdefault("properties", {})[name] = value


class ConanFile:
    def __init__(self):
        chosen = {name: name in sys.argv[3:] or default for name, default in self.default_options.items()}
        assert set(chosen) == set(self.options) and all(value in self.options[name] for name, value in chosen.items())
        self.options = types.SimpleNamespace(**chosen)
        self.recipe_folder = str(root / "packaging/conan")
        self.export_sources_folder = self.source_folder = str(work / "source")
        self.build_folder, self.package_folder = str(work / "build"), str(work / "package")
        self.cpp_info, self.needs = CppInfo(), []

    def requires(self, reference):
        self.needs.append(reference)


class Toolchain:
    def __init__(self, recipe):
        self.recipe, self.cache_variables = recipe, {}

    def generate(self):
        self.recipe.cache = {name: "ON" if value is True else "OFF" for name, value in self.cache_variables.items()}


class CMake:
    def __init__(self, recipe):
        self.recipe = recipe

    def call(self, *arguments):
        subprocess.run(["cmake", *arguments], check=True, stdout=subprocess.DEVNULL)

    def configure(self):
        of = self.recipe
        self.call("-S", of.source_folder, "-B", of.build_folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                  "-DCMAKE_INSTALL_PREFIX=" + of.package_folder, "-DCMAKE_INSTALL_LIBDIR=lib",
                  *(f"-D{name}={value}" for name, value in of.cache.items()))

    def build(self):
        self.call("--build", self.recipe.build_folder)

    def install(self):
        self.call("--install", self.recipe.build_folder)


def copy(_, pattern, src, dst):
    found = list(pathlib.Path(src).glob(pattern.replace("/*", "/**/*")))
    assert found, f"the recipe copies {pattern}, and there is no such file"
    for path in found:
        target = pathlib.Path(dst) / path.relative_to(src)
        if path.is_file():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, target)


def module(name, **content):
    sys.modules[name] = types.ModuleType(name)
    sys.modules[name].__dict__.update(content)


module("conan", ConanFile=ConanFile)
module("conan.tools")
module("conan.tools.build", check_min_cppstd=lambda recipe, standard: None)
module("conan.tools.cmake", CMake=CMake, CMakeToolchain=Toolchain, cmake_layout=lambda recipe: None,
       CMakeDeps=lambda recipe: types.SimpleNamespace(generate=lambda: None))
module("conan.tools.files", copy=copy)

shutil.rmtree(work, ignore_errors=True)
spec = importlib.util.spec_from_file_location("conanfile", root / "packaging/conan/conanfile.py")
recipe_file = importlib.util.module_from_spec(spec)
spec.loader.exec_module(recipe_file)
recipe = recipe_file.Wisp()
for step in ("set_version", "export_sources", "requirements", "validate", "layout", "generate", "build", "package", "package_info"):
    getattr(recipe, step)()

package = pathlib.Path(recipe.package_folder)
missing = [name for name in recipe.cpp_info.libs if not (package / f"lib/lib{name}.a").exists()]
assert not missing, f"the recipe names libraries that it does not pack: {missing}"
assert (package / "licenses/LICENSE").exists() and recipe.version.count(".") == 2
print(package / recipe.cpp_info.builddirs[0])
