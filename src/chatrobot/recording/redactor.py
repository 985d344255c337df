"""What every text passes before it is written to a recording: keys, tokens and secret values leave it.

Three nets: the keys and tokens in use, whatever the environment holds under a name that sounds secret, and whatever
looks like a key. Text is redacted as it is written (JSON), so each secret is looked for in the forms it has there.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Mapping

from chatrobot.models.secret import HIDDEN, Secret, scrub

SHORTEST = 6
"""Shorter values (`none`, `1`) are no secrets; hiding them would mutilate ordinary words."""
_SECRET_NAME = re.compile(
    r"KEY(?!BOARD|MAP)|TOKEN|SECRET|PASSW|PASSPHRASE|_PASS$|^PASS$|PWD$|CREDENTIAL|AUTH|COOKIE|PRIVATE"
    r"|(?:^|_)PAT$|(?:^|_)PIN$|DSN",
    re.IGNORECASE,
)
_NO_SECRETS = frozenset({"PWD", "OLDPWD", "SSH_AUTH_SOCK", "XAUTHORITY"})
"""Folders and sockets: where something is, which a text may well name."""
_LOOKS_LIKE_ONE = re.compile(
    r"(?<=://)[^/\s@\"\\]+(?=@)|"  # user and password in an address
    r"\b(?:gh[pousr]_|github_pat_|glpat-|xox[abprs]-|hf_|AKIA|ASIA|ya29\.)[A-Za-z0-9._\-]{12,}|"
    r"\beyJ[A-Za-z0-9_\-]{8,}\.[A-Za-z0-9_\-]{8,}\.[A-Za-z0-9_\-]{8,}|"  # a JSON web token
    r"-----BEGIN [A-Z ]*PRIVATE KEY-----.*?(?:-----END [A-Z ]*PRIVATE KEY-----|$)",
    re.DOTALL,
)


class Redactor:
    """Call it with a text.

    Args:
        in_use: the keys and tokens in use just now; asked by `refresh`, for some are known only later.
        environment: variables by name.
    """

    def __init__(self, in_use: Callable[[], Iterable[str]], environment: Mapping[str, str]) -> None:
        self._in_use = in_use
        self._always = {
            value
            for name, value in environment.items()
            if _SECRET_NAME.search(name) and name not in _NO_SECRETS
        }
        self._known: set[str] = set()
        self._pattern: re.Pattern[str] | None = None
        self.refresh()

    def refresh(self) -> None:
        """Take in the keys and tokens that have come into use. What was one stays hidden."""
        values = {value.strip() for value in (*self._always, *self._in_use())}
        known = self._known | {value for value in values if len(value) >= SHORTEST}
        if known != self._known:
            self._known = known
            forms = {form for value in known for form in _forms(value)}
            # The longest first: one secret may begin with another.
            longest_first = sorted(forms, key=len, reverse=True)
            self._pattern = re.compile("|".join(map(re.escape, longest_first)))

    def __call__(self, text: str) -> str:
        """Return the text without any secret."""
        if self._pattern is not None:
            text = self._pattern.sub(HIDDEN, text)
        return scrub(_LOOKS_LIKE_ONE.sub(HIDDEN, text), _NONE)


_NONE = Secret("")


def _forms(value: str) -> set[str]:
    """As it is and as JSON writes it, once and twice: a text that quotes it is itself in an event."""
    forms = {value, repr(value)[1:-1]}
    for _ in range(2):
        forms |= {
            json.dumps(form, ensure_ascii=is_ascii)[1:-1] for form in forms for is_ascii in (True, False)
        }
    return forms
