"""The exercises of the course: ``ask_03_1(seed)`` asks, ``check_03_1(answer, seed)`` says right or gives a hint.

Another seed gives another student other numbers; without one everybody has those of the notebook.
"""

from primer.exercises.cidr_theorem import ask_07_1, ask_07_2, ask_07_3, check_07_1, check_07_2, check_07_3
from primer.exercises.granular_rheologies import ask_06_1, ask_06_2, ask_06_3, check_06_1, check_06_2, check_06_3
from primer.exercises.grid_dependence import (
    ask_03_1,
    ask_03_2,
    ask_03_3,
    ask_03_5,
    check_03_1,
    check_03_2,
    check_03_3,
    check_03_5,
)
from primer.exercises.living_with_ill_posedness import ask_08_1, ask_08_2, ask_08_3, check_08_1, check_08_2, check_08_3
from primer.exercises.scheme_or_pde import (
    ask_04_1,
    ask_04_2,
    ask_04_3,
    ask_04_5,
    check_04_1,
    check_04_2,
    check_04_3,
    check_04_5,
)
from primer.exercises.speed_against_error import ask_05_1, ask_05_2, ask_05_3, check_05_1, check_05_2, check_05_3
from primer.exercises.start_here import ask_00_1, ask_00_2, check_00_1, check_00_2
from primer.exercises.testing_a_pde import (
    ask_02_1,
    ask_02_2,
    ask_02_3,
    ask_02_4,
    check_02_1,
    check_02_2,
    check_02_3,
    check_02_4,
)
from primer.exercises.what_can_be_saved import ask_10_1, ask_10_2, check_10_1, check_10_2
from primer.exercises.what_ill_posed_means import ask_01_1, ask_01_2, ask_01_3, check_01_1, check_01_2, check_01_3
from primer.exercises.write_it_yourself import ask_09_1, ask_09_2, check_09_1, check_09_2

__all__ = [
    "ask_00_1",
    "ask_00_2",
    "ask_01_1",
    "ask_01_2",
    "ask_01_3",
    "ask_02_1",
    "ask_02_2",
    "ask_02_3",
    "ask_02_4",
    "ask_03_1",
    "ask_03_2",
    "ask_03_3",
    "ask_03_5",
    "ask_04_1",
    "ask_04_2",
    "ask_04_3",
    "ask_04_5",
    "ask_05_1",
    "ask_05_2",
    "ask_05_3",
    "ask_06_1",
    "ask_06_2",
    "ask_06_3",
    "ask_07_1",
    "ask_07_2",
    "ask_07_3",
    "ask_08_1",
    "ask_08_2",
    "ask_08_3",
    "ask_09_1",
    "ask_09_2",
    "ask_10_1",
    "ask_10_2",
    "check_00_1",
    "check_00_2",
    "check_01_1",
    "check_01_2",
    "check_01_3",
    "check_02_1",
    "check_02_2",
    "check_02_3",
    "check_02_4",
    "check_03_1",
    "check_03_2",
    "check_03_3",
    "check_03_5",
    "check_04_1",
    "check_04_2",
    "check_04_3",
    "check_04_5",
    "check_05_1",
    "check_05_2",
    "check_05_3",
    "check_06_1",
    "check_06_2",
    "check_06_3",
    "check_07_1",
    "check_07_2",
    "check_07_3",
    "check_08_1",
    "check_08_2",
    "check_08_3",
    "check_09_1",
    "check_09_2",
    "check_10_1",
    "check_10_2",
]
