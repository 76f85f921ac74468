"""Pulse interpolation for PLCs: straight moves of any mechanism as positioning tables (docs/pulses.md)."""
