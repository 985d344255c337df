"""What the sandbox is on machines that give it less: old kernels, containers, switched-off features."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from chatrobot.sandbox.syscalls import this_machine
from chatrobot.sandbox.warm_server import probe

INSIDE = Path(__file__).parent / "inside"
ON_A_POORER_MACHINE = """
import json, sys
from chatrobot.sandbox.seccomp import ALLOW, ERRNO, Is, Rule, assemble
from chatrobot.sandbox.seccomp import install
from chatrobot.sandbox.syscalls import this_machine
missing, has_filters = json.loads(sys.argv[2]), sys.argv[3] == "yes"
machine = this_machine()
machine.numbers.update(prctl={"x86_64": 157, "aarch64": 167}[machine.name])
rules = [Rule((name,), ERRNO | number) for name, number in missing.items()]
if not has_filters:
    rules.append(Rule(("prctl",), ERRNO | 22, when=((Is(0, 22),),), otherwise_code=ALLOW))
install(assemble(machine, rules, default_code=ALLOW))

from pathlib import Path
from chatrobot.sandbox.warm_server import probe
from chatrobot.sandbox.warm_server import WarmServer
report = probe()
said = {"level": report.level, "standing": report.standing, "refusal": report.refusal and report.refusal.code}
if report.refusal is None:
    with WarmServer([Path(sys.argv[1])], ["sandbox_entries"]) as server:
        server.start()
        with server.launch("sandbox_entries:run_source", b"import time; time.sleep(60)") as process:
            process.kill()
            said["ended"] = process.wait(10).reason.code
        with server.launch("sandbox_entries:run_source", b"open('/etc/passwd')") as process:
            said["code"] = process.wait(10).exit_code
            said["logs"] = process.read_logs()
print(json.dumps(said))
"""
EPERM, ENOSYS = 1, 38
OLD_KERNEL = dict.fromkeys(
    ("landlock_create_ruleset", "pidfd_open", "pidfd_send_signal", "clone3", "unshare"), ENOSYS
)
CONTAINER = {"unshare": EPERM, "mount": EPERM, "pivot_root": EPERM, "setns": EPERM, "keyctl": EPERM}


def on_a_poorer_machine(missing: dict[str, int], *, has_filters: bool = True) -> dict[str, object]:
    """Probe and use the sandbox under a filter that takes calls away."""
    if this_machine() is None or probe().refusal is not None:
        pytest.skip("no filters on this machine")
    words = [str(INSIDE), json.dumps(missing), "yes" if has_filters else "no"]
    ran = subprocess.run(
        [sys.executable, "-c", ON_A_POORER_MACHINE, *words], capture_output=True, text=True, timeout=60
    )
    assert ran.returncode == 0, ran.stderr
    return dict(json.loads(ran.stdout))


def test_an_old_kernel_has_the_sound_minimum() -> None:
    """No Landlock, no process descriptors, no namespaces: as Linux 4.14 on many robots."""
    said = on_a_poorer_machine(OLD_KERNEL)
    assert said["level"] == "minimum"
    assert said["ended"] == "box_killed"
    assert said["code"] == 1
    assert "PermissionError" in str(said["logs"])


def test_a_container_that_allows_no_namespaces_has_landlock() -> None:
    said = on_a_poorer_machine(CONTAINER)
    assert "namespaces" not in list(said["standing"])  # type: ignore[call-overload]
    assert said["level"] == ("good" if "landlock" in probe().standing else "minimum")
    assert "PermissionError" in str(said["logs"])


def test_without_filters_programs_are_refused() -> None:
    said = on_a_poorer_machine({}, has_filters=False)
    assert said["level"] == "none"
    assert said["refusal"] == "box_not_possible"


def test_another_kind_of_machine_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("platform.machine", lambda: "riscv64")
    assert this_machine() is None
