"""Carries out one command of ./run, after the set-up that it still needs."""

import sys

import build
import project
from setup import cache, device_access, pcl, platforms, steps
from setup.steps import Step


def main(command: str, arguments: list[str]) -> int:
    steps.run(needed(command, arguments))
    return COMMANDS[command](arguments)


def needed(command: str, arguments: list[str]) -> list[Step]:
    if command == "test" and (emulated := [platforms.tested_by(argument) for argument in arguments]) and any(emulated):
        return steps.for_platforms([platform for platform in emulated if platform])
    if "--device-access" in arguments:
        return []
    if command == "docs":
        return [steps.python()]
    plan = steps.dependencies()
    if "--with-sensing" in arguments or (command == "bench" and "sensing" in arguments and pcl.can_fetch()):
        plan.append(Step("PCL's headers", pcl.is_ready, pcl.fetch_headers))
    debug, release, imported = build.step("template_debug"), build.step("template_release"), project.import_step()
    if command == "bench" or any(argument.startswith("--sanitize") for argument in arguments):
        return plan
    if command == "addon":
        plan += steps.of_platforms(platforms.named_in(arguments))
    if command in ("setup", "export", "addon", "test", "proof"):
        return [*plan, steps.export_template(), debug, release, imported]
    return [*plan, debug, imported, *([project.help_step()] if command == "edit" else [])]


def setup(arguments: list[str]) -> int:
    if "--device-access" in arguments:
        return device_access.install()
    print(f"All there. What was fetched and built outside the clone is in {cache.root()}.")
    return 0


def demo(_: list[str]) -> int:
    return experiment(["scenario1"]) or experiment(["scenario4"]) or cache.run_tool("report.py")


def test(arguments: list[str]) -> int:
    return cache.run_tool("testing/run_tests.py", *arguments)


def proof(arguments: list[str]) -> int:
    return cache.run_tool("prove.py", *arguments)


def bench(arguments: list[str]) -> int:
    return cache.run_tool("bench.py", *arguments)


def experiment(arguments: list[str]) -> int:
    return cache.run_tool("experiment.py", *arguments)


def replay(arguments: list[str]) -> int:
    return cache.run_tool("replay.py", *arguments)


def docs(arguments: list[str]) -> int:
    return cache.run_tool("docs.py", *arguments)


def edit(arguments: list[str]) -> int:
    return project.run("--editor", *arguments)


def app(arguments: list[str]) -> int:
    return project.run(*arguments)


def export(_: list[str]) -> int:
    return project.export()


def addon(arguments: list[str]) -> int:
    return cache.run_tool("addon.py", *arguments)


COMMANDS = {
    function.__name__: function
    for function in (setup, demo, test, proof, bench, experiment, replay, docs, edit, app, export, addon)
}

if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1], sys.argv[2:]))
    except RuntimeError as error:
        print(error, file=sys.stderr)
        sys.exit(1)
    except KeyboardInterrupt:
        sys.exit(130)
