"""Carries out one command of ./run: its words are checked first, then what it still needs is set up."""

import sys
from collections.abc import Sequence

import arguments
import build
import commands
import entry
import project
from arguments import Given
from measuring.options import Refused
from setup import cache, device_access, pcl, platforms, processes, steps
from setup.steps import Step


def main(words: Sequence[str]) -> int:
    try:
        asked = read(words)
    except Refused as refusal:
        print(refusal, file=sys.stderr)
        return entry.USAGE
    if isinstance(asked, str):
        print(asked, end="")
        return 0
    name, given = asked
    return processes.kept(lambda: entry.ended(lambda: carry_out(name, given)))


def read(words: Sequence[str]) -> str | tuple[str, Given]:
    """The help that is asked for, or a command and what was given to it."""
    if not words or words[0] == "help" or words[0] in arguments.HELP:
        if len(words) > 1:
            raise Refused("./run --help stands alone; ./run COMMAND --help says what one command takes")
        return arguments.usage(commands.TABLE)
    try:
        command = commands.BY_NAME[arguments.choose(words[0], commands.BY_NAME, "command")]
    except Refused as refusal:
        raise Refused(f"./run: {refusal}{'' if str(refusal).endswith('?') else '.'} See ./run --help") from None
    if arguments.asks_for_help(words[1:]):
        details = command.details(tuple(word for word in words[1:] if word not in arguments.HELP))
        return arguments.usage([command]) + (f"\n{details}\n" if details else "")
    return command.name, arguments.read(command, words[1:])


def carry_out(name: str, given: Given) -> int:
    if code := processes.run_to_its_end([cache.clone() / "tools/debian_packages.sh", *packages(name, given)]):
        return code
    steps.run(needed(name, given))
    return COMMANDS[name](given)


def packages(name: str, given: Given) -> list[str]:
    """What must come from the system: words of debian_packages.sh. What only other platforms need is asked for where they are."""
    if given.has("--device-access"):
        return ["python"]
    if _makes_pages_alone(name, given):
        return ["pages"]
    elsewhere = platforms.tested_by(given.words[0]) if name == "test" and given.words else None
    if elsewhere:
        return ["build", elsewhere.name, "wine" if elsewhere.system == "windows" else "qemu"]
    extra = {"proof": ["sensing", "proof"], "test": ["sensing"]}.get(name, [])
    if name == "bench" and "sensing" in given.words:
        extra = ["sensing", "rival"]
    if given.has("--pictures") or (name == "experiment" and given.words == ("scenario5",)):
        extra = ["sensing"]
    if given.has("--with-sensing"):
        extra = ["with_sensing"]
    return ["build", *extra, *(one.name for one in _others(given))]


def needed(name: str, given: Given) -> list[Step]:
    if name == "test" and given.words and (emulated := platforms.tested_by(given.words[0])):
        return steps.for_platforms([emulated])
    if given.has("--device-access"):
        return []
    if _makes_pages_alone(name, given):
        return [steps.python()]
    plan = steps.dependencies()
    if given.has("--with-sensing") or (name == "bench" and "sensing" in given.words and pcl.can_fetch()):
        plan.append(Step("PCL's headers", pcl.is_ready, pcl.fetch_headers))
    if name in ("bench", "test") or given.has("--figures"):
        return [*plan, steps.checkers(), steps.older_interfaces(), steps.export_template()] if name == "test" and not given.has("--sanitize") else plan
    # Eyes where a scene may ask for them; the demo's do not.
    eyes = () if name == "demo" or (name == "experiment" and "scenario5" not in given.words) else ("sensing",)
    debug, release = build.step("template_debug", *eyes), build.step("template_release", *eyes)
    imported = project.import_step()
    plan += steps.of_platforms(_others(given))
    if given.has("--godot"):
        plan.append(steps.older_interfaces())
    if name in ("setup", "export", "addon", "proof"):
        return [*plan, steps.export_template(), debug, release, imported]
    return [*plan, debug, imported, *([project.help_step()] if name == "edit" else [])]


def _makes_pages_alone(name: str, given: Given) -> bool:
    """The documents out of what is in the clone: figures and pictures are made by what was built."""
    return name == "docs" and not (given.has("--figures") or given.has("--pictures"))


def _others(given: Given) -> list[platforms.Platform]:
    """The platforms that --platform=NAME,… names, besides this machine's own."""
    asked = [f"--platform={given.options['--platform']}"] if given.has("--platform") else []
    return platforms.named_in([*asked, *(["--all"] if given.has("--all") else [])])


def setup(given: Given) -> int:
    if given.has("--device-access"):
        return device_access.install()
    print(f"All there. What was fetched and built outside the clone is in {cache.root()}.")
    return 0


def demo(_: Given) -> int:
    networked = ("experiment.py", "timing_networked", "--seconds=5", "--rounds=1")
    tools = (("experiment.py", "scenario1"), networked, ("experiment.py", "scenario4"), ("report.py",))
    return next((code for tool in tools if (code := cache.run_tool(*tool))), 0)


def edit(given: Given) -> int:
    code = project.run("--editor", *map(commands.scene, given.words))
    processes.await_descendants()  # an editor that starts anew is another process
    return code


def app(given: Given) -> int:
    rest = ("--", *given.rest) if given.rest else ()
    return project.run(*map(commands.scene, given.words), *rest)


def export(_: Given) -> int:
    return project.export()


def _tool(script: str):
    return lambda given: cache.run_tool(script, *given.raw)


COMMANDS = {
    "setup": setup, "demo": demo, "test": _tool("testing/run_tests.py"), "proof": _tool("prove.py"), "bench": _tool("bench.py"),
    "experiment": _tool("experiment.py"), "replay": _tool("replay.py"), "docs": _tool("docs.py"), "edit": edit, "app": app,
    "export": export, "addon": _tool("addon.py"),
}  # fmt: skip

if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
