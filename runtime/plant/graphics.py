"""Where MuJoCo draws without a window: EGL on the graphics device or on Mesa's software, else OSMesa.

MuJoCo's own contexts (``mujoco.egl``, ``mujoco.osmesa``) fix the library of a process at import, by the environment,
and cannot change to the other one; a run that is drawn has imported MuJoCo long before. So the few calls that a context
needs are made here. MuJoCo itself looks up its functions by the variable ``MUJOCO_GL`` when it begins to draw, which is
set to match. A user who has set it chooses by it.
"""

import ctypes
import os
from collections.abc import Callable
from typing import Any, Protocol

import runtime.appearance.codes  # noqa: F401 - registers what is raised here
from runtime.core.faults import Fault

VARIABLE = "MUJOCO_GL"
"""The environment variable by which MuJoCo, and a user, choose between ``egl`` and ``osmesa``."""
EGL_LIBRARY, OSMESA_LIBRARIES = "libEGL.so.1", ("libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so")

_MOST_DEVICES = 16
_EGL_PLATFORM_DEVICE = 0x313F
_EGL_OPENGL_API = 0x30A2
_EGL_NONE = 0x3038
# 8 bits of red, green, blue, alpha; 24 of depth; 8 of stencil; a pixel buffer; desktop OpenGL
_EGL_ATTRIBUTES = (
    *(0x3024, 8, 0x3023, 8, 0x3022, 8, 0x3021, 8),
    *(0x3025, 24, 0x3026, 8, 0x3033, 0x0001, 0x3040, 0x0008),
    _EGL_NONE,
)
_OSMESA_RGBA, _GL_UNSIGNED_BYTE = 0x1908, 0x1401


class _UnusableError(Exception):
    """A library that is not there or cannot draw; the text says why."""


class Graphics(Protocol):
    """A place to draw in, current in the thread that made it until ``close``."""

    @property
    def title(self) -> str:
        """Its name for people."""

    def close(self) -> None:
        """Give it back."""


class Egl:
    """A context of EGL without any surface: MuJoCo draws into a buffer of its own."""

    title = "EGL"

    def __init__(self) -> None:
        """Open it; ``_UnusableError``."""
        self._egl = _library(EGL_LIBRARY)
        self._display = self._first_display()
        config, found = ctypes.c_void_p(), ctypes.c_int()
        attributes = (ctypes.c_int * len(_EGL_ATTRIBUTES))(*_EGL_ATTRIBUTES)
        self._egl.eglChooseConfig(self._display, attributes, ctypes.byref(config), 1, ctypes.byref(found))
        self._egl.eglBindAPI(_EGL_OPENGL_API)
        create = self._function("eglCreateContext", ctypes.c_void_p, *[ctypes.c_void_p] * 4)
        self._context = create(self._display, config, None, None) if found.value else None
        if not self._context or not self._current(self._context):
            self._egl.eglTerminate(self._display)
            raise _UnusableError("EGL gives no OpenGL context")

    def close(self) -> None:
        """Give it back."""
        self._current(None)
        self._egl.eglDestroyContext(self._display, ctypes.c_void_p(self._context))
        self._egl.eglTerminate(self._display)

    def _first_display(self) -> ctypes.c_void_p:
        """Return the display of the first device that can be initialised: a headless machine has no default one."""
        devices, count = (ctypes.c_void_p * _MOST_DEVICES)(), ctypes.c_int()
        query = self._extension("eglQueryDevicesEXT", ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.c_void_p)
        query(_MOST_DEVICES, ctypes.byref(devices), ctypes.byref(count))
        of = self._extension(
            "eglGetPlatformDisplayEXT", ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p
        )
        for device in devices[: count.value]:
            display = ctypes.c_void_p(of(_EGL_PLATFORM_DEVICE, device, None))
            if display and self._egl.eglInitialize(display, None, None):
                return display
        raise _UnusableError("EGL has no device to draw with")

    def _extension(self, name: str, result: Any, *arguments: Any) -> Callable[..., Any]:
        address = self._function("eglGetProcAddress", ctypes.c_void_p, ctypes.c_char_p)(name.encode())
        if not address:
            raise _UnusableError(f"EGL has no {name}")
        found: Callable[..., Any] = ctypes.CFUNCTYPE(result, *arguments)(address)
        return found

    def _function(self, name: str, result: Any, *arguments: Any) -> Callable[..., Any]:
        # a pointer is longer than the int that ctypes takes a result for
        function: Any = getattr(self._egl, name)
        function.restype, function.argtypes = result, arguments
        return function  # type: ignore[no-any-return]

    def _current(self, context: int | None) -> bool:
        return bool(self._egl.eglMakeCurrent(self._display, None, None, ctypes.c_void_p(context)))


class Osmesa:
    """A context of OSMesa, which draws by the processor alone; its own picture is one pixel and is not used."""

    title = "OSMesa"

    def __init__(self) -> None:
        """Open it; ``_UnusableError``."""
        self._mesa = _library(*OSMESA_LIBRARIES)
        create = self._mesa.OSMesaCreateContextExt
        create.restype = ctypes.c_void_p
        self._context = ctypes.c_void_p(create(_OSMESA_RGBA, 24, 8, 0, None))
        self._pixel = (ctypes.c_ubyte * 4)()
        if not self._context or not self._mesa.OSMesaMakeCurrent(self._context, self._pixel, _GL_UNSIGNED_BYTE, 1, 1):
            raise _UnusableError("OSMesa gives no OpenGL context")

    def close(self) -> None:
        """Give it back."""
        self._mesa.OSMesaMakeCurrent(None, None, _GL_UNSIGNED_BYTE, 0, 0)
        self._mesa.OSMesaDestroyContext(self._context)


KINDS: dict[str, type[Egl] | type[Osmesa]] = {"egl": Egl, "osmesa": Osmesa}
"""What there is, by the value of ``VARIABLE``, the first choice first."""


def open_graphics() -> Graphics:
    """Return a context that can draw, current in this thread; ``Fault`` RBL830 where there is none."""
    chosen = os.environ.get(VARIABLE, "").strip().lower()
    reasons = []
    for name, kind in KINDS.items():
        if chosen in KINDS and name != chosen:
            continue
        try:
            graphics = kind()
        except _UnusableError as error:
            reasons.append(str(error))
            continue
        # read by MuJoCo's loader of OpenGL functions, which must ask the library whose context is current
        os.environ[VARIABLE] = name
        return graphics
    limited = f" ({VARIABLE} is {chosen})" if chosen in KINDS else ""
    raise Fault("RBL830", f"nothing can draw without a window here: {'; '.join(reasons)}{limited}")


def _library(*names: str) -> Any:
    for name in names:
        try:
            return ctypes.CDLL(name, mode=ctypes.RTLD_GLOBAL)
        except OSError:
            continue
    raise _UnusableError(f"{names[0]} is not installed")
