#!/bin/sh
# Make .venv with everything in it, or with what the extras named need; do nothing where it has that already.
# setup.sh [EXTRAS]
set -eu
extras=${1:-dev}
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

# The stamp says from which files and with which extras .venv was made. There is none while pip works: where it was
# interrupted, .venv is made anew. With CI=true the very versions of the lock file; otherwise the newest that pyproject.toml allows.
sources=$(cat pyproject.toml requirements.lock scripts/setup.sh | cksum)-${CI:-}
installed=$(cat "$stamp" 2>/dev/null) || installed=
if [ -x "$venv/bin/chatrobot" ]; then
    case $installed in "$sources $extras" | "$sources dev") exit 0 ;; esac
fi

echo "setup: installing ChatRobot and what it needs into $venv (a minute or so; later only when pyproject.toml changes)"
[ -n "$installed" ] && "$venv/bin/python" -m pip --version >/dev/null 2>&1 || "$python" -m venv --clear "$venv"
rm -f "$stamp"
trap 'exit 130' INT TERM
constraints=
[ "${CI:-}" = true ] && constraints="-c requirements.lock"
# shellcheck disable=SC2086  # no constraints are no argument
"$venv/bin/python" -m pip install --quiet --disable-pip-version-check $constraints -e ".[$extras]" ||
    {
        printf '%s' "$installed" >"$stamp"
        fail "pip could not install everything: see above (is the network there?)"
    }
printf '%s %s' "$sources" "$extras" >"$stamp"
