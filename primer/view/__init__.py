"""Pictures: a style sheet and ``draw_*(axes, result)`` functions shared by figures, notebooks and explorers."""
