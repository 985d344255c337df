"""A provider of language models, as release 0.1 takes one."""

from chatrobot.models.providers import Provider

PROVIDER = Provider("acme", "Acme", needs_key=False, base_url="http://localhost:7777/v1", example="one")
