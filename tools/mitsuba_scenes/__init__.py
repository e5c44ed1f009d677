"""Mitsuba 3 scenes as scenes of vkpm, by Mitsuba's own parser and plugins."""
