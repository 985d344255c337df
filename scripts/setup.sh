#!/bin/sh
# Make .venv with everything in it; do nothing where it is there already and pyproject.toml has not changed.
set -eu
python=${PYTHON:-python3}
venv=.venv
stamp=$venv/.installed

fail() {
    printf 'setup: %s\n' "$@" >&2
    exit 1
}

command -v "$python" >/dev/null 2>&1 ||
    fail "there is no $python here." "install it, such as: sudo apt-get install python3 python3-venv"
"$python" -c 'import sys; sys.exit(sys.version_info < (3, 10))' ||
    fail "$($python --version) is too old: Python 3.10 or newer is needed." \
        "install one and name it, such as: make setup PYTHON=python3.12"
"$python" -c 'import ensurepip, venv' 2>/dev/null ||
    fail "$python can make no virtual environments." "install what is missing, such as: sudo apt-get install python3-venv"

# With CI=true the very versions of the lock file; otherwise the newest that pyproject.toml allows.
wanted=$(cat pyproject.toml requirements.lock scripts/setup.sh | cksum)-${CI:-}
if [ -x "$venv/bin/chatrobot" ] && [ "$(cat "$stamp" 2>/dev/null)" = "$wanted" ]; then
    exit 0
fi

echo "setup: making $venv (a minute or two; later only when pyproject.toml changes)"
"$venv/bin/python" -m pip --version >/dev/null 2>&1 || "$python" -m venv --clear "$venv"
constraints=
[ "${CI:-}" = true ] && constraints="-c requirements.lock"
echo "setup: installing ChatRobot and what it needs"
# shellcheck disable=SC2086  # no constraints are no argument
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check $constraints -e '.[dev]' ||
    fail "pip could not install everything: see above (is the network there?)"
printf '%s' "$wanted" >"$stamp"
echo "setup: done; start with: make run"
