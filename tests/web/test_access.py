"""Nobody comes in who was not let in: foreign names, foreign pages, tokens that are none, paths that lead elsewhere."""

from __future__ import annotations

import socket
from pathlib import Path
from typing import Any

import pytest
from starlette.applications import Starlette
from starlette.testclient import TestClient
from websockets.exceptions import ConnectionClosed, InvalidStatus

from chatrobot.web.access import Access, Pass, Refusal
from chatrobot.web.class_recordings import ClassRecordings, recording_routes
from chatrobot.web.limits import Guesses
from tests.processes import wait_until
from tests.web.rig import Client, WebRig, serving


def status_of(rig: WebRig, path: str = "/ws", **how: Any) -> int:
    """The HTTP status with which a WebSocket is refused; 101 where it is not."""
    try:
        rig.dial(path, **how).close()
    except InvalidStatus as error:
        return error.response.status_code
    return 101


# --- pages of others ---


@pytest.mark.parametrize(
    "origin",
    [
        "http://evil.example",
        "http://127.0.0.1",
        "http://127.0.0.1:1",
        "http://localhost.evil.example",
        "https://127.0.0.1:{port}",
        "http://localhost:{port}",  # our own page, by another name than that of the request
        "null",
        None,
    ],
)
@pytest.mark.parametrize("line", ["page", "stop"])
def test_no_other_site_opens_a_websocket(rig: WebRig, origin: str | None, line: str) -> None:
    port = rig.access.stop_port if line == "stop" else rig.access.port
    path = "/stop" if line == "stop" else "/ws"
    origin = origin.format(port=rig.access.port) if origin else origin
    assert status_of(rig, path, port=port, origin=origin) == 403


@pytest.mark.parametrize(
    "host", ["evil.example", "evil.example:{port}", "127.0.0.1:1", "192.168.1.1:{port}", ""]
)
def test_a_foreign_host_is_refused(rig: WebRig, host: str) -> None:
    """A site whose name is made to point here (DNS rebinding) gets nothing, not even the page."""
    host = host.format(port=rig.access.port)
    for path in ("/", "/me", "/nothing"):
        assert rig.http().get(path, headers={"Host": host}).status_code in (400, 421)
    answer = rig.http().get("/", headers={"Host": f"localhost:{rig.access.port}"})
    assert answer.status_code == 200


def test_a_foreign_host_opens_no_websocket(rig: WebRig) -> None:
    for path, port in (("/ws", rig.access.port), ("/stop", rig.access.stop_port)):
        request = (
            f"GET {path} HTTP/1.1\r\nHost: evil.example:{port}\r\nOrigin: http://evil.example:{port}\r\n"
            "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
            "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
        )
        with socket.create_connection(("127.0.0.1", port), 5.0) as line:
            line.sendall(request.encode())
            assert line.recv(1000).split()[1] in (b"421", b"403")


def test_a_form_of_another_site_enters_nothing(rig: WebRig) -> None:
    answer = rig.http().post("/enter", json={"token": "x"}, headers={"Origin": "http://evil.example"})
    assert answer.status_code == 403
    assert "set-cookie" not in answer.headers


def test_every_answer_forbids_what_the_page_does_not_need(rig: WebRig) -> None:
    for path in ("/", "/me", "/nothing", "/enter"):
        headers = rig.http().get(path).headers
        policy = headers["content-security-policy"]
        assert "unsafe" not in policy
        assert "default-src 'none'" in policy
        assert f"ws://127.0.0.1:{rig.access.stop_port}" in policy
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"
        assert "access-control-allow-origin" not in headers


@pytest.mark.parametrize(
    "path",
    [
        "/../pyproject.toml",
        "/..%2f..%2fserver.py",
        "/%2e%2e/server.py",
        "/..\\server.py",
        "//etc/passwd",
        "/page/index.html",
        "/__init__.py",
        "/index.html%00.js",
        "/index.html/../../access.py",
    ],
)
def test_only_the_files_of_the_page_are_served(rig: WebRig, path: str) -> None:
    with socket.create_connection(("127.0.0.1", rig.access.port), 5.0) as line:
        line.sendall(f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1:{rig.access.port}\r\n\r\n".encode())
        assert line.recv(1000).split()[1] in (b"400", b"404")


# --- tokens ---


@pytest.fixture
def guarded() -> Any:
    access = Access("127.0.0.1", needs_token=True)
    access.issue("steerer", token="steers-it")
    access.issue("watcher", token="looks-on")
    with serving(access) as rig:
        yield rig


def test_without_a_token_nobody_comes_in(guarded: WebRig) -> None:
    assert guarded.http().get("/me").status_code == 401
    assert status_of(guarded) == 401
    assert status_of(guarded, "/stop", port=guarded.access.stop_port) == 403
    assert guarded.http().get("/").status_code == 200, "the page itself is no secret: it takes the token in"


def test_the_token_becomes_a_cookie_that_no_script_and_no_other_site_has(guarded: WebRig) -> None:
    client = guarded.http()
    answer = client.post("/enter", json={"token": "steers-it"}, headers={"Origin": guarded.origin})
    assert answer.json()["role"] == "steerer"
    cookie = answer.headers["set-cookie"]
    assert "HttpOnly" in cookie
    assert "SameSite=Strict" in cookie
    assert client.get("/me").json()["role"] == "steerer"
    page = guarded.page(additional_headers={"Cookie": cookie.partition(";")[0]})
    assert page.heard[0]["role"] == "steerer"


def test_under_tls_the_cookie_never_travels_in_clear() -> None:
    assert "Secure" in Access("0.0.0.0", is_secure=True).cookie(Pass("steerer", token="t"))


def test_who_has_the_token_of_a_watcher_never_steers(guarded: WebRig) -> None:
    page = guarded.page(additional_headers={"Authorization": "Bearer looks-on"})
    assert page.wait_for("steering")["by"] is None
    for do, fields in (("take", {}), ("say", {"text": "forward 1 m"}), ("release", {})):
        page.say(do, **fields)
        assert page.wait_for("refused", do=do)["why"] in ("may_only_watch", "not_for_you")
    page.say("stop")
    guarded.session.wait_for("stop", "the Stop button")


def test_wrong_tokens_are_slowed_down_and_the_right_one_beside_them_is_not(guarded: WebRig) -> None:
    headers = {"Origin": guarded.origin}
    inside = guarded.http(headers={"Authorization": "Bearer looks-on"})
    assert inside.get("/me").status_code == 200
    client = guarded.http()
    tried = [client.post("/enter", json={"token": f"t{n}"}, headers=headers).status_code for n in range(12)]
    assert tried == [401] * 10 + [429] * 2
    right = client.post("/enter", json={"token": "steers-it"}, headers=headers)
    assert right.status_code == 429, "a guess that is right has to wait, too"
    assert status_of(guarded, additional_headers={"Authorization": "Bearer steers-it"}) == 429
    assert inside.get("/me").status_code == 200


def test_pages_of_an_earlier_server_keep_nobody_out(guarded: WebRig) -> None:
    headers = {"Origin": guarded.origin}
    earlier = Access("127.0.0.1", needs_token=True)
    client = guarded.http()
    for _ in range(12):
        token = earlier.issue("pupil", "1")
        assert client.post("/enter", json={"token": token}, headers=headers).status_code == 401
    assert client.post("/enter", json={"token": "steers-it"}, headers=headers).status_code == 200


def test_a_chosen_token_is_not_guessed_though_it_is_as_long_as_those_that_are_made() -> None:
    access = Access("127.0.0.1", needs_token=True)
    access.issue("steerer", token="a" * 32)
    tried = [access.check_token(f"{n:032}", "10.0.0.1") for n in range(11)]
    assert [one.status for one in tried if isinstance(one, Refusal)] == [401] * 10 + [429]


def test_guesses_are_forgotten_after_a_minute() -> None:
    now = [0.0]
    guesses = Guesses(lambda: now[0])
    for _ in range(10):
        guesses.note_wrong("10.0.0.1")
    assert guesses.has_to_wait("10.0.0.1")
    assert not guesses.has_to_wait("10.0.0.2")
    now[0] = 61.0
    assert not guesses.has_to_wait("10.0.0.1")


def test_what_is_revoked_is_closed_at_once_and_opens_nothing_more(guarded: WebRig) -> None:
    how = {"additional_headers": {"Authorization": "Bearer steers-it"}}
    page, line = guarded.page(**how), guarded.stop_line(**how)
    page.say("say", text="forward 1 m")
    guarded.session.wait_for("say", "forward 1 m")
    guarded.revoke("steers-it")
    guarded.session.wait_for("stop", "the steering page is gone")
    with pytest.raises(ConnectionClosed):
        page.wait_for("nothing")
    line.say("stop")
    with pytest.raises(ConnectionClosed, match="1008"):
        line.wait_for("stopped")
    assert status_of(guarded, **how) == 401


@pytest.mark.parametrize(
    "body", [b"", b"[]", b"{", b'{"token": 7}', b'{"token": ""}', b"x" * 5000, b"[" * 4000]
)
def test_whatever_is_posted_as_a_token_is_answered(guarded: WebRig, body: bytes) -> None:
    headers = {"Origin": guarded.origin, "Content-Type": "application/json"}
    assert guarded.http().post("/enter", content=body, headers=headers).status_code in (400, 413)


# --- what is decided without a server ---


def scope(
    host: str, origin: str | None = None, kind: str = "http", client: str = "10.0.0.9"
) -> dict[str, Any]:
    headers = [(b"host", host.encode())] + ([(b"origin", origin.encode())] if origin is not None else [])
    return {"type": kind, "method": "GET", "headers": headers, "client": (client, 5)}


def open_to_all(token: str = "good-token") -> Access:
    access = Access("0.0.0.0", needs_token=True)
    access.port, access.stop_port = 8080, 8081
    access.issue("steerer", token=token)
    return access


def test_from_elsewhere_an_address_is_a_name_of_ours_and_a_strangers_name_is_not() -> None:
    access = open_to_all()
    assert access.check_place(scope("192.168.1.7:8080"), 8080) is None
    assert access.check_place(scope("evil.example:8080"), 8080) is not None
    assert (
        access.check_place(scope("192.168.1.7:8080", "http://evil.example:8080", "websocket"), 8080)
        is not None
    )
    ours = scope("192.168.1.7:8081", "http://192.168.1.7:8080", "websocket")
    assert access.check_place(ours, 8081) is None


def test_only_at_this_machine_a_steerer_may_release() -> None:
    access = open_to_all()
    here, afar = access.check_token("good-token", "127.0.0.1"), access.check_token("good-token", "10.0.0.9")
    assert isinstance(here, Pass)
    assert isinstance(afar, Pass)
    assert here.may_release
    assert not afar.may_release
    assert not Pass("pupil", is_local=True).may_release
    assert Pass("teacher").may_release


def test_who_stands_before_us_cannot_say_who_asks() -> None:
    """An address in a header (X-Forwarded-For) makes nobody local."""
    asked = scope("192.168.1.7:8080")
    asked["headers"] += [(b"x-forwarded-for", b"127.0.0.1"), (b"authorization", b"Bearer good-token")]
    admitted = open_to_all().admit(asked)
    assert isinstance(admitted, Pass)
    assert not admitted.is_local


def test_a_header_that_stands_twice_is_none() -> None:
    asked = scope("192.168.1.7:8080")
    asked["headers"] += [(b"host", b"evil.example:8080")]
    assert isinstance(open_to_all().check_place(asked, 8080), Refusal)


def test_a_pass_does_not_show_its_token() -> None:
    assert "good-token" not in repr(open_to_all().check_token("good-token", "10.0.0.9"))


def test_two_servers_of_one_machine_have_two_cookies(guarded: WebRig) -> None:
    other = Access("127.0.0.1", needs_token=True)
    other.port = guarded.access.port + 1
    assert other.cookie_name("") != guarded.access.cookie_name("")


def test_the_console_of_one_robot_opens_no_other() -> None:
    access = Access("127.0.0.1", needs_token=True)
    access.issue("pupil", "a", token="pupil-a")
    access.issue("teacher", "", token="teaches")
    with serving(access, ("a", "b")) as rig:
        pupil = {"additional_headers": {"Authorization": "Bearer pupil-a"}}
        teacher = {"additional_headers": {"Authorization": "Bearer teaches"}}
        assert rig.page("/ws?room=b", **pupil).heard[0]["room"] == "a"
        assert rig.page("/ws?room=b", **teacher).heard[0]["room"] == "b"
        assert status_of(rig, "/ws?room=c", **teacher) == 404
        line = Client(rig.dial("/stop?room=b", access.stop_port, **pupil))
        line.say("stop")
        line.wait_for("stopped")
        wait_until(lambda: rig.sessions["a"].log == [("stop", "the Stop button")])
        assert rig.sessions["b"].log == []


def test_whoever_is_refused_writes_nothing_into_the_terminal(
    rig: WebRig, caplog: pytest.LogCaptureFixture
) -> None:
    assert status_of(rig, origin="http://evil.example") == 403
    rig.server.close()
    assert [record for record in caplog.records if record.name.startswith("uvicorn")] == []


def test_recordings_of_a_class_are_for_a_teachers_token_alone(tmp_path: Path) -> None:
    access = Access("127.0.0.1", needs_token=True)
    tokens = {role: access.issue(role, "1" * (role == "pupil")) for role in ("watcher", "pupil", "steerer")}
    tokens["teacher"] = access.issue("teacher")
    routes = recording_routes(access, ClassRecordings(tmp_path, tuple))
    with TestClient(Starlette(routes=routes)) as http:
        asked = (("GET", "", 200), ("DELETE", "", 200), ("GET", "/a.mcap", 404), ("DELETE", "/a.mcap", 404))
        for method, where, found in asked:
            for role, token in tokens.items():
                bearer = {"Authorization": f"Bearer {token}"}
                answer = http.request(method, f"/recordings{where}", headers=bearer)
                assert answer.status_code == (found if role == "teacher" else 403), (role, method, where)
