"""Who may come in: Host and Origin against pages of others, tokens against strangers, roles for what each may do."""

from __future__ import annotations

import hmac
import ipaddress
import secrets
import socket
from collections.abc import Mapping
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from typing import Any, Literal
from urllib.parse import parse_qs

from chatrobot.web.limits import Guesses, is_loopback_address

Role = Literal["steerer", "watcher", "pupil", "teacher"]
Scope = Mapping[str, Any]
LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]"})
TOKEN_BYTES = 24
_MADE_CHARS = len(secrets.token_urlsafe(TOKEN_BYTES))
STOP_BUTTON, EMERGENCY_BUTTON = "the Stop button", "the Emergency stop button"
_DEFAULT_PORTS = {"http": 80, "https": 443}


@dataclass(frozen=True)
class Pass:
    """What whoever holds it may do with which robot. `room` is "" for all robots of a class.

    `is_local`: they sit at this very machine, which then is the local console.
    """

    role: Role
    room: str = ""
    is_local: bool = False
    token: str = field(default="", repr=False)

    @property
    def seat(self) -> str:
        """Return what tells this pass from others that one browser may hold: a cookie, and an address, of its own.

        Whoever steers the robot, or teaches, has the address of the server itself.
        """
        return "" if self.role in ("steerer", "teacher") else "-".join(filter(None, (self.role, self.room)))

    @property
    def may_steer(self) -> bool:
        """They may say what the robot does, once they steer."""
        return self.role != "watcher"

    def pressed(self, button: str) -> str:
        """Return why the robot is told to stop, where the holder pressed that button: a pupil hears of a teacher."""
        return button.replace("the ", "the teacher's ", 1) if self.role == "teacher" else button

    @property
    def may_release(self) -> bool:
        """They may release an emergency stop: at the local console, and a teacher that of the class."""
        return self.role == "teacher" or (self.role == "steerer" and self.is_local)


@dataclass(frozen=True)
class Refusal:
    """Why nobody comes in, and as which HTTP status that is told."""

    status: int
    text: str


class Access:
    """Decides by what a request says of itself. Any thread may ask.

    Args:
        host: where the server listens.
        is_secure: it speaks TLS.
        needs_token: nobody comes in without one.
        open_as: what who comes in without one is.
    """

    def __init__(
        self, host: str, *, is_secure: bool = False, needs_token: bool = False, open_as: Role = "steerer"
    ) -> None:
        self.host = host
        self._open_as = open_as
        self.scheme = "https" if is_secure else "http"
        self.needs_token = needs_token
        self.port = self.stop_port = 0
        self.guesses = Guesses()
        self._passes: dict[str, Pass] = {}
        self._has_chosen_alike = False
        """Somebody chose a token that is as long as those that are made here."""
        self._admitted: set[tuple[str, str]] = set()
        """Address and token of those who were let in: they need not wait because somebody beside them guesses."""

    # --- tokens ---

    def issue(self, role: Role, room: str = "", token: str = "") -> str:
        """Return a new token for that role and robot, or make `token` it."""
        self._has_chosen_alike |= len(token) == _MADE_CHARS
        token = token or secrets.token_urlsafe(TOKEN_BYTES)
        self._passes = {**self._passes, token: Pass(role, room, token=token)}
        return token

    def revoke(self, token: str) -> None:
        """Let nobody in with that token any more; its connections are closed by those who hold them."""
        self._passes = {known: one for known, one in self._passes.items() if known != token}
        self._admitted = {one for one in self._admitted if one[1] != token}

    @property
    def tokens(self) -> tuple[str, ...]:
        """Return those that are good, oldest first."""
        return tuple(self._passes)

    def is_valid(self, pass_: Pass) -> bool:
        """Return whether a pass that was good when it came in still is."""
        return not pass_.token or pass_.token in self._passes

    def pass_of(self, token: str) -> Pass | None:
        """Return what that token is good for. Each is compared, in constant time."""
        found = None
        given = token.encode("utf-8", "surrogateescape")
        for known, one in self._passes.items():
            if hmac.compare_digest(known.encode(), given):
                found = one
        return found

    # --- requests ---

    def check_place(self, scope: Scope, port: int) -> Refusal | None:
        """Refuse what another site had a browser send: a Host or an Origin that is not ours."""
        headers = _headers(scope)
        name, number = _split_host(headers.get("host", ""), self.scheme)
        if number != port or not self._is_ours(name):
            return Refusal(421, "this server is not known by that name: open the address that it printed")
        origin = headers.get("origin")
        is_asked = scope["type"] == "websocket" or scope.get("method") not in ("GET", "HEAD")
        if origin != self.origin(name) and (is_asked or origin is not None):
            return Refusal(403, "only the page of this server itself may ask that")
        return None

    def admit(self, scope: Scope) -> Pass | Refusal:
        """Return what whoever asks may do, by the cookie that `/enter` gave, or by a bearer token."""
        address = address_of(scope)
        is_local = is_loopback_address(address)
        if not self.needs_token:
            return Pass(self._open_as, is_local=is_local)
        seat = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("as", [""])[0]
        token = _token_in(_headers(scope), self.cookie_name(seat))
        if not token:
            return Refusal(401, "a token is needed: open the link that the server printed")
        return self.check_token(token, address)

    def check_token(self, token: str, address: str) -> Pass | Refusal:
        """Return what that token is good for; whoever guesses has to wait."""
        found = self.pass_of(token)
        is_known = found is not None and (address, token) in self._admitted
        if self.guesses.has_to_wait(address) and not is_known:
            return Refusal(429, "too many wrong tokens: wait a minute")
        if found is not None:
            self._admitted.add((address, token))
            return Pass(found.role, found.room, is_loopback_address(address), found.token)
        if self._may_be_guessed(token):
            self.guesses.note_wrong(address)
        return Refusal(401, "this token is not valid (any more): ask for a new link")

    def _may_be_guessed(self, token: str) -> bool:
        """Pages left open over an end of the server bring a token that it, or a teacher, has ended: 192 random bits.

        Nobody guesses one of those; were they counted, the old pages of a class would lock its teacher out.
        """
        return len(token) != _MADE_CHARS or self._has_chosen_alike

    def cookie_name(self, seat: str) -> str:
        """Return the name of a seat's cookie. Cookies know no ports: two servers on one machine need two names."""
        return f"chatrobot_{self.port}" + (f"_{seat}" if seat else "")

    def cookie(self, pass_: Pass) -> str:
        """Return what sets the cookie: for this very site alone, and out of reach of any script."""
        secure = "; Secure" if self.scheme == "https" else ""
        return f"{self.cookie_name(pass_.seat)}={pass_.token}; Path=/; HttpOnly; SameSite=Strict{secure}"

    def origin(self, name: str, port: int | None = None) -> str:
        """Return the origin of our page, as a browser that knows us by that name writes it."""
        port = self.port if port is None else port
        return f"{self.scheme}://{name}" + ("" if port == _DEFAULT_PORTS[self.scheme] else f":{port}")

    def headers(self, scope: Scope) -> dict[str, str]:
        """Return the headers that every response has."""
        name, _ = _split_host(_headers(scope).get("host", ""), self.scheme)
        name = name if self._is_ours(name) else "127.0.0.1"
        sockets = [self.origin(name, port).replace("http", "ws", 1) for port in (self.port, self.stop_port)]
        policy = (
            "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
            f"connect-src 'self' {' '.join(sockets)}; worker-src 'self'; manifest-src 'self'; "
            "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
        )
        return {
            "Content-Security-Policy": policy,
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Cross-Origin-Opener-Policy": "same-origin",
            "Cross-Origin-Resource-Policy": "same-origin",
        }

    def _is_ours(self, name: str) -> bool:
        """A page of somebody else may have its own name point to us (DNS rebinding), but never an address."""
        if is_loopback(self.host):
            return name in LOOPBACK_NAMES
        this = socket.gethostname().casefold()
        return (
            name in LOOPBACK_NAMES
            or name in (self.host.casefold(), this, f"{this}.local")
            or _is_address(name)
        )


def is_loopback(host: str) -> bool:
    """Return whether only this machine reaches a server that listens there."""
    return host == "localhost" or is_loopback_address(host)


def address_of(scope: Scope) -> str:
    """Return where a request comes from."""
    client = scope.get("client")
    return str(client[0]) if client else ""


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True


def _headers(scope: Scope) -> dict[str, str]:
    """The headers of a request. One that stands twice is none: which is meant would be a guess."""
    found: dict[str, str] = {}
    for raw_name, raw_value in scope["headers"]:
        name = raw_name.decode("latin-1").lower()
        found[name] = (
            ""
            if name in found and name in ("host", "origin", "authorization")
            else raw_value.decode("latin-1")
        )
    return found


def _split_host(host: str, scheme: str) -> tuple[str, int]:
    """Name and port of a Host header; port 0 where it is none."""
    name, colon, port = host.casefold().rpartition(":")
    if not colon or port.endswith("]"):
        return host.casefold(), _DEFAULT_PORTS[scheme]
    return name, int(port) if port.isdecimal() and len(port) <= 5 else 0


def _token_in(headers: Mapping[str, str], cookie_name: str) -> str:
    scheme, _, bearer = headers.get("authorization", "").partition(" ")
    if scheme.casefold() == "bearer":
        return bearer.strip()
    try:
        cookie = SimpleCookie(headers.get("cookie", "")).get(cookie_name)
    except CookieError:
        return ""
    return cookie.value if cookie is not None else ""
