"""robolang: an industrial robot controller in a package."""

__version__ = "0.1.0"
