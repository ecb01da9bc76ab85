#!/usr/bin/env python3
"""Writes the godot-cpp API for the classes in classes.txt, from the engine's own description of itself.

    generate.py --api FOLDER --output DIR
    generate.py --profile FILE

reads FOLDER/extension_api.json and FOLDER/gdextension_interface.h, writes DIR/include and DIR/src. The hand-written
half is in include/ and src/ beside this file. The second form writes the same list of classes as a build profile, with
which upstream godot-cpp builds these alone.
"""

import argparse
import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))

from generator.api import Api  # noqa: E402
from generator.builtins import write_builtins  # noqa: E402
from generator.engine_classes import write_classes  # noqa: E402
from generator.global_scope import write_global_constants, write_sizes, write_utility_functions  # noqa: E402
from generator.interface import write_interface  # noqa: E402
from generator.output import Output  # noqa: E402


def read_class_list(path):
    lines = path.read_text(encoding="utf-8").splitlines()
    return [line.strip() for line in lines if line.strip() and not line.startswith("#")]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--api", type=Path, help="folder of the engine's dump, or extension_api.json")
    parser.add_argument("--interface", type=Path, help="gdextension_interface.h, if it is not beside the JSON")
    parser.add_argument("--output", type=Path, help="folder to write include/ and src/ into")
    parser.add_argument("--classes", type=Path, default=HERE / "classes.txt", help="list of engine classes")
    parser.add_argument("--profile", type=Path, help="build profile to write, for upstream godot-cpp")
    parser.add_argument("--report", action="store_true", help="list the methods that were left out")
    arguments = parser.parse_args()
    classes = read_class_list(arguments.classes)
    if arguments.profile is not None:
        arguments.profile.write_text(json.dumps({"enabled_classes": classes}, indent=4) + "\n", encoding="utf-8")
        return
    if arguments.api is None or arguments.output is None:
        parser.error("--api and --output are needed, or --profile alone")

    description = arguments.api / "extension_api.json" if arguments.api.is_dir() else arguments.api
    interface = arguments.interface or description.parent / "gdextension_interface.h"
    api = Api(description, classes)
    output = Output(arguments.output)
    write_interface(output, interface.read_text(encoding="utf-8"))
    write_sizes(api, output)
    write_global_constants(api, output)
    write_builtins(api, output)
    write_utility_functions(api, output)
    writers = write_classes(api, output)
    output.remove_stale()

    if arguments.report:
        for writer in writers:
            for name, reason in writer.left_out:
                print(f"{writer.name}.{name}: {reason}")
    print(f"binding: {len(writers)} classes, {sum(writer.methods for writer in writers)} methods")


if __name__ == "__main__":
    main()
