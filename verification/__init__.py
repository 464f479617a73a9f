"""Runs cases, judges them against independent references and reports. It sees only files and programs."""
