"""What arv-test prints, read."""
import re


def conformance(text):
    """Its lines: {"Genicam:Load": ("SUCCESS", "comment")}. (The exit code is 0 whatever they say.)"""
    text = re.sub(r"\x1b\[[0-9;]*m", "", text)
    return {match[1]: (match[2], match[3].strip())
            for match in re.finditer(r"^(\w+:\w+)\s+(SUCCESS|FAILURE|IGNORED)(.*)$", text, re.M)}
