"""Where the settings of a controller come from: files and options, one over another.

A setting is taken from the first of these that gives it: an option of the command line, the profile file, the cell's
``[controller]``, the robot file (bandwidths only), the default. ``Settings`` keeps with every value where it came
from, so that a value that cannot be used is refused at its own place and ``robolang config show`` can show it.
A profile file has ``schema = 1`` and the same ``[controller]`` table as a cell.
"""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from runtime.core.faults import Fault, raise_all
from runtime.core.record import Record
from runtime.core.tomlfile import FileFault, Source, Table, inside, load_table, read_source
from runtime.settings.profile import Profile
from runtime.settings.setting import Setting, groups_of, settings_of

T = TypeVar("T", bound=Record)

MOST_NEAR = 4
"""Keys in the hint for one that does not exist; more would hide the right one."""
_IDEAL_WHEN_MEASURED = ("servo.velocity_feedforward", "servo.acceleration_feedforward")
_FEEDS_BACK_WHEN_MEASURED = (*_IDEAL_WHEN_MEASURED, "servo.spring_compensation")


def settings() -> dict[str, Setting]:
    """Return every key of ``[controller]``, dotted, in the order of the documentation."""
    found = {item.key: item for item in settings_of(Profile).values()}
    for _, name, kind in groups_of(Profile):
        found.update((f"{name}.{item.key}", item) for item in settings_of(kind).values())
    return found


class Given(Record):
    """A value as its file writes it, and its place: ``origin`` for people; the table when there is one."""

    value: Any
    origin: str
    table: Table | None = None
    name: str = ""

    def fault(self, code: str, message: str, hint: str = "") -> Fault:
        """Return what refuses the value where it was given: ``FileFault`` in a file, else one that names the option."""
        if self.table is not None:
            return self.table.fault(code, message, hint, key=self.name)
        return Fault(code, f"{self.origin}: {message}", hint)

    def fail(self, code: str, message: str, hint: str = "") -> NoReturn:
        """Refuse the value: raise its ``fault``."""
        raise self.fault(code, message, hint)


Layer = Mapping[str, Given]
"""What one file or the command line gives, by dotted key."""


class Settings(Record):
    """Every key with its effective value and origin, and the profile they make."""

    given: Layer
    profile: Profile = Profile()

    def __getitem__(self, key: str) -> Given:
        return self.given[key]


def read_layer(table: Table | None) -> Layer:
    """Read ``[controller]`` of a file; ``FileFault`` RBL6xx at the key that is wrong. None gives nothing."""
    if table is None:
        return {}
    found = _read(table, Profile, "")
    for _, name, kind in groups_of(Profile):
        inner = table.table(name, required=False)
        found |= _read(inner, kind, f"{name}.")
        inner.done()
    table.done()
    return found


def _read(table: Table, kind: type[Record], prefix: str) -> dict[str, Given]:
    """Read the settings of a data class, by dotted key."""
    settings = settings_of(kind).values()
    found = {
        prefix + item.key: Given(value=_value(table, item), origin=table.place(item.key), table=table, name=item.key)
        for item in settings
        if item.key in table
    }
    # absent keys too: a misspelt key is answered with the known ones that it resembles
    table.ask(*(item.key for item in settings))
    return found


def _value(table: Table, item: Setting) -> Any:
    """Return the value of a setting, None where it is wrong and everything that is wrong is gathered."""
    return table.attempt(lambda: item.read(table, item.key))


def load_profile_file(path: Path) -> Layer:
    """Read a profile file: ``schema = 1`` and ``[controller]`` as in a cell; ``FileFault`` at what is wrong."""
    table = load_table(read_source(path), gather=True)
    table.integer("schema", low=1, high=1)
    layer = table.table("controller").gather(read_layer)
    table.finish()
    return layer or {}


def read_options(values: Mapping[str, tuple[str, Any]]) -> Layer:
    """Return the layer of options: by dotted key the option's name and its value; ``Fault`` that names the option."""
    layer = {}
    for key, (option, value) in values.items():
        if key not in settings():
            raise Fault("RBL609", f"{option}: '{key}' is not a key of the controller profile", _near(key))
        try:
            # by the reader of the file, so that a range is stated once; its place is the name of the option
            taken = settings()[key].read(Table(Source(option, ""), {key: value}, ()), key)
        except FileFault as fault:
            raise Fault(fault.code, f"{option}: {fault.message}", fault.hint) from None
        layer[key] = Given(value=taken, origin=option)
    return layer


def _near(key: str) -> str:
    """Return a hint with the keys that one which does not exist may stand for."""
    import difflib  # needed for a hint only

    last = key.rpartition(".")[2].lower()
    names = {known: known.rpartition(".")[2] for known in settings()}  # without the group, which all keys of it share
    slip = difflib.get_close_matches(last, names.values(), n=1, cutoff=0.7)
    near = [known for known, name in names.items() if last and (last in name or name in slip)]
    guess = f"did you mean {' or '.join(near)}? " if 0 < len(near) <= MOST_NEAR else ""
    return f"{guess}robolang config show lists the keys"


def settle(*layers: Layer) -> Settings:
    """Put the layers together, later ones over earlier ones, and check what can be checked without a robot."""
    given = {key: Given(value=item.default, origin="default") for key, item in settings().items()}
    chosen = {key: value for layer in layers for key, value in layer.items()}
    given.update(chosen)
    # last, since a bound may depend on two keys that come from different files
    raise_all([*_measured(given, chosen), *_fixed(given, chosen)])
    return Settings(given=given, profile=_made(Profile, given))


def _measured(given: dict[str, Given], chosen: Layer) -> list[Fault]:
    """Give the gains of a measured feed-forward their defaults, 0; return what is wrong with those that are given.

    A derivative that is measured contains what it caused: a gain of 1 feeds all of it back (docs/servo.md).
    """
    if given["servo.feedforward"].value != "measured":
        return []
    given.update((key, Given(value=0.0, origin="default")) for key in _FEEDS_BACK_WHEN_MEASURED if key not in chosen)
    return [
        given[key].fault(
            "RBL616",
            f"'controller.{key}' must be below 1 when the feed-forward is measured",
            'give a value such as 0.9, or write feedforward = "command"',
        )
        for key in _IDEAL_WHEN_MEASURED
        if not given[key].value < 1.0
    ]


def _fixed(given: dict[str, Given], chosen: Layer) -> list[Fault]:
    """Give fixed gains the coupling that they have by default; return what is wrong with the one that is given."""
    if given["servo.mode"].value != "fixed":
        return []
    if "servo.coupling" not in chosen:
        given["servo.coupling"] = Given(value="diagonal", origin="default")
    elif given["servo.coupling"].value == "full":
        fault = given["servo.coupling"].fault(
            "RBL605",
            "'controller.servo.coupling' must be \"diagonal\" when the gains are fixed",
            "fixed gains hold the inertia of each axis alone",
        )
        return [fault]
    return []


def _made(kind: type[T], given: Layer, prefix: str = "") -> T:
    """Return a data class of settings with the values that are given, in SI."""
    values = {name: item.si(given[prefix + item.key].value) for name, item in settings_of(kind).items()}
    for name, key, inner in groups_of(kind):
        values[name] = _made(inner, given, f"{key}.")
    return kind(**values)


def check_axes(settings: Settings, axes: int, robot: str) -> None:
    """Refuse a setting for each axis that has another number of entries than the robot axes (RBL613)."""
    faults: list[Fault] = []
    for name in ("position", "velocity"):
        given = settings[f"servo.{name}_bandwidth_rad_s"]
        if len(given.value) not in (0, 1, axes):  # 0: the robot file's own
            message = f"'servo.{name}_bandwidth_rad_s' has {len(given.value)} entries; {robot} has {axes} axes"
            faults.append(given.fault("RBL613", message, "give one number for all axes or one for each"))
    raise_all(faults)


def compensation_file(settings: Settings) -> Path | None:
    """Return the compensation file that is named, None for none; ``FileFault`` RBL602.

    A file names one inside of its own folder only, an option any.
    """
    given = settings["servo.compensation"]
    if not given.value:
        return None
    # an option is typed by the user; a cell file may come from someone else and must not reach other folders
    if given.table is None:
        return Path(given.value)
    return inside(given.table, given.value, Path(given.table.source.path).parent, given.name)
