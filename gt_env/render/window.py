def available() -> bool:
    return False


def why_unavailable() -> str:
    return "no display"


class Window:
    def __init__(self, title, size, fps):
        raise RuntimeError


