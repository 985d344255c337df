"""The web console: a page for people, on one session; see docs/web.md."""
