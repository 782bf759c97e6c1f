"""Answers to the exercises by a second route; a module for each notebook, ``truth_NN_K(seed)`` for ``check_NN_K``."""
