"""Writes the part of the godot-cpp API that follows from the engine's own description of itself."""
