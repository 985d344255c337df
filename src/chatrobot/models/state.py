"""Whether a model could be asked now, as far as that is known without asking it."""

from __future__ import annotations

from importlib.util import find_spec

from chatrobot.core.reason import Reason
from chatrobot.models.config import ModelConfig
from chatrobot.models.failures import Place
from chatrobot.models.keys import where_key_is
from chatrobot.models.make import EXTRA
from chatrobot.models.providers import split_name
from chatrobot.models.seam import ModelError

LIBRARY = "pydantic_ai"


def problem_with(name: str, config: ModelConfig) -> Reason | None:
    """What stands in the way of asking `PROVIDER:NAME`: its name, the extra, the key, the address. Sends nothing."""
    try:
        provider, model = split_name(name)
    except ModelError as error:
        return error.reason
    if provider.make is not None:
        return None
    if find_spec(LIBRARY) is None:
        return Reason("model_missing_extra", {"command": EXTRA, "provider": provider.name})
    place = Place(provider, model, provider.address(config), None)
    if provider.needs_key and not where_key_is(provider, config):
        return place.reason("model_no_key")
    if not place.address:
        return place.reason("model_no_address", variable=provider.base_url_variables[0])
    return None
