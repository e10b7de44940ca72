#!/usr/bin/env python3
# SPDX-License-Identifier: LGPL-2.1-or-later
# Copyright 2026 the gst-spidar authors
"""Writes a C++ source with a function for each one that a header of GLFW declares; it calls the
function of that name in the copy of GLFW that private_glfw.h describes.

    forwards.py glfw3.h forwards.cpp"""
import re
import sys

# Functions that need the types of Vulkan are declared only if its header is included, too.
DECLARATION = re.compile(r"^GLFWAPI ([^(]*?)\s*(glfw\w+)\(((?:(?!Vk|PFN_vk)[^)])*)\);$", re.MULTILINE)

header, output = sys.argv[1:]
with open(header, encoding="utf-8") as file:
    declarations = DECLARATION.findall(file.read())
lines = ['#include <iterator>', '', '#define GLFW_INCLUDE_NONE', '#include <GLFW/glfw3.h>', '',
         '#include "plugin/window/glfw/private_glfw.h"', '',
         'namespace {', 'const char* const names[] = {']
lines += [f'    "{name}",' for _, name, _ in declarations]
lines += ['};', 'void* functions[std::size(names)];', '}  // namespace', '',
          'std::string spidar::load_glfw() {',
          '  return load_glfw(names, functions, std::size(names));', '}', '', 'extern "C" {']
for number, (result, name, parameters) in enumerate(declarations):
    arguments = [] if parameters == "void" else [p.split()[-1].lstrip("*") for p in parameters.split(",")]
    lines.append(f"{result} {name}({parameters}) {{ return reinterpret_cast<decltype(&{name})>"
                 f"(functions[{number}])({', '.join(arguments)}); }}")
lines.append("}")
with open(output, "w", encoding="utf-8") as file:
    file.write("\n".join(lines) + "\n")
