"""Codes of pictures, registered at import; the module imports nothing heavy."""

from runtime.core.faults import Code, register

register(
    Code(
        code="RBL830",
        name="no-graphics",
        meaning="No library is there that draws without a window: neither EGL nor OSMesa.",
        remedy="Install one of them: on Debian and Ubuntu 'apt-get install libegl1 libegl-mesa0 libgl1-mesa-dri', or "
        "'apt-get install libosmesa6'.",
    ),
    Code(
        code="RBL831",
        name="film-writer-missing",
        meaning="The library that writes films of this format is not installed.",
        remedy="Install the extra: pip install 'robolang[video]'; a picture as .png needs none.",
    ),
    Code(
        code="RBL832",
        name="picture-unsuitable",
        meaning="A picture or film cannot be made as it was ordered: its format, time, size or rate.",
        remedy="Give a file that ends in .png, .gif, .webp or .mp4, edges from 16 to 4096 pixels, and for a .png "
        "a time within the run. A run without motion has no picture.",
    ),
    Code(
        code="RBL833",
        name="scene-invalid",
        meaning="The scene in a log is not one: a body, shape, pose or mesh in it is missing, or out of its bounds.",
        remedy="Make the log again with robolang run --log.",
    ),
)
