"""Guards the explorers: every control's corners answer, errors are said in words, states can be copied and restored."""

import gc
import html
import io
import itertools

import numpy as np
import pytest
from matplotlib.image import imread

import primer
from primer.view import PDEExplorer, explorers
from primer.view.explorers.controls import Choice, Line, Number
from primer.view.explorers.switch import Switch
from primer.view.picture import Picture

EXPLORERS = [getattr(explorers, name) for name in explorers.__all__]
every = pytest.mark.parametrize("explorer", EXPLORERS, ids=lambda explorer: explorer.__name__)


def pixels(png):
    return imread(io.BytesIO(png))


def ends(control):
    """The values a reader can reach that are likeliest to break something."""
    if isinstance(control, Number):
        return (control.low, control.high)
    return control.options if isinstance(control, Choice) else (control.default,)


@every
def test_begins_with_a_picture_and_a_verdict(explorer):
    shown = explorer()
    assert shown.verdict
    assert pixels(shown.png).std() > 0.01
    assert shown.widget.children


@pytest.mark.slow
@every
def test_every_corner_of_the_controls_gives_a_picture_and_a_verdict(explorer):
    shown, controls = explorer(), (*explorer.controls, *explorer.looks)
    for corner in itertools.product(*map(ends, controls)):
        state = dict(zip((control.name for control in controls), corner, strict=True))
        shown.set(**state)
        assert 'role="status"' in shown._said.value, (state, shown.verdict)
        assert shown.verdict
        assert "nan" not in shown.verdict.split()


@pytest.mark.slow
@every
def test_a_state_comes_back(explorer):
    for state in explorer.presets.values():
        first = explorer.from_state(state)
        second = explorer.from_state(first.state)
        assert (second.state, second.verdict) == (first.state, first.verdict)
        assert np.array_equal(pixels(second.png), pixels(first.png))


@pytest.mark.slow
@every
def test_reset_and_presets_lead_back_to_the_same_picture(explorer):
    shown = explorer()
    begun = shown.state, shown.verdict, shown.png
    for name in explorer.presets:
        shown.preset(name)
        assert shown.verdict == explorer.from_state(explorer.presets[name]).verdict
    shown.reset()
    assert (shown.state, shown.verdict, shown.png) == begun


@pytest.mark.slow
@every
def test_presets_differ_in_what_they_say(explorer):
    said = [explorer.snapshot(state).verdict for state in explorer.presets.values()]
    assert len(set(said)) == len(said)


@pytest.mark.slow
@every
def test_one_change_is_answered_once(explorer, monkeypatch):
    shown, asked = explorer(), []
    png = Picture.png
    monkeypatch.setattr(Picture, "png", lambda self, *args: asked.append(args) or png(self, *args))
    for control in (c for c in explorer.controls if isinstance(c, Number)):
        asked.clear()
        slider, box = shown._rows[control.name].widget.children[:2]
        slider.value = control.low
        assert len(asked) == 1, control.name
        assert box.value == pytest.approx(control.low)
        box.value = control.high
        assert len(asked) == 2, control.name
        assert slider.value == pytest.approx(control.high)


@every
def test_what_is_wrong_is_said_and_can_be_put_right(explorer):
    shown = explorer()
    begun = shown.verdict
    for control in (c for c in explorer.controls if isinstance(c, Number)):
        box = shown._rows[control.name].widget.children[1]
        box.value = -(10**9)
        assert shown.verdict.startswith(f"{control.label} ({control.name}) must ")
        assert "got" in shown.verdict
        assert 'role="alert"' in shown._said.value
        assert "primer-stale" in shown._image._dom_classes  # an old picture would mislead
        box.value = control.default
        assert shown.verdict == begun
        assert 'role="status"' in shown._said.value
        assert "primer-stale" not in shown._image._dom_classes


@every
def test_looks_stay_on_their_sliders_and_whole_numbers_are_whole(explorer):
    shown = explorer()
    for control in explorer.looks:
        box = shown._rows[control.name].widget.children[1]
        for value in (control.low - 1, control.high * 1.01, float("nan")):
            box.value = value
            assert shown.verdict.startswith(f"{control.label} ({control.name}) must ")
        box.value = control.default
    for control in (c for c in explorer.controls if isinstance(c, Number) and c.whole):
        shown._rows[control.name].widget.children[1].value = 65.5
        assert shown.verdict.startswith(f"{control.label} ({control.name}) must be")
        assert "got 65.5" in shown.verdict


def test_a_number_box_takes_what_is_typed(monkeypatch):
    """An IntText in a browser makes 655 of 65.5, so that the boxes of whole numbers are of the other kind."""
    for control in (c for explorer in EXPLORERS for c in explorer.controls if isinstance(c, Number)):
        assert type(control.build(lambda: None).widget.children[1]).__name__ == "FloatText"


def test_playing_ends_where_the_run_does_and_begins_where_the_slider_is():
    shown = explorers.BaseStateExplorer.from_state("a=0.5")
    slider, _, play = shown._rows["t"].widget.children
    assert play.max == int(np.ceil(2 * shown._answer.run.t_stop))
    slider.value = 5.0
    assert play.value == 10
    shown.set(a=1.5, t=100.0)
    assert (play.max, play.value) == (200, 0)


@every
def test_the_picture_has_alternative_text_that_changes_with_it(explorer):
    shown = explorer()
    for state in ("", list(explorer.presets.values())[-1]):
        shown._go_to(state)
        words = html.escape(shown.verdict)
        assert f'alt="{words}"' in shown._image.value
        assert f'alt="{words}"' in shown._repr_mimebundle_()["text/html"]


@pytest.mark.slow
@every
def test_states_and_names_that_make_no_sense(explorer):
    with pytest.raises(ValueError, match=r"state must be NAME=VALUE .* got 'nonsense'"):
        explorer.from_state("nonsense")
    with pytest.raises(TypeError, match="the controls of"):
        explorer(nonsense=1)
    with pytest.raises(ValueError, match="name must be one of"):
        explorer().preset("nonsense")
    shown = explorer()
    begun = shown.state
    shown._copy.value = "nonsense=1"
    assert shown.verdict.startswith("state must be")
    assert shown.state == begun


@every
def test_labels_are_there_for_those_who_listen(explorer):
    for control in (*explorer.controls, *explorer.looks):
        assert control.label
        row = control.build(lambda: None)
        assert row.widget.children[0].description == control.label
        if isinstance(control, Number):
            assert row.widget.children[1].tooltip == control.label
    assert all(isinstance(control, (Number, Choice, Line, Switch)) for control in explorer.controls)


def test_another_pde_starts_clean():
    for explorer in (PDEExplorer.from_state("pde=u_t = -u_xx"), PDEExplorer(pde="u_t = -u_xx")):
        assert explorer.verdict.startswith("Ill posed")
        assert explorer.values["at"] == ""
    assert PDEExplorer.snapshot("pde=u_t = -u_xx").verdict == explorer.verdict
    assert PDEExplorer.from_state("n=32").values["at"] == PDEExplorer().values["at"] != ""


def test_a_uniform_base_state_is_a_tick():
    asked = PDEExplorer.from_state("pde=u_t = u u_xx,at=u=1")
    assert "uniform base state (uniform) must be yes" in asked.verdict
    asked.set(uniform=True)
    assert asked.verdict.startswith("Well posed")
    assert PDEExplorer.from_state(asked.state).verdict == asked.verdict
    with pytest.raises(ValueError, match="uniform must be yes or no, got 'perhaps'"):
        PDEExplorer.from_state("uniform=perhaps")


def test_the_explorer_speaks_its_own_language():
    assert "give k=..." not in PDEExplorer.from_state("pde=u_t = u_xx - f").verdict
    assert "f=... in the base state" in PDEExplorer.from_state("pde=u_t = u_xx - f").verdict
    assert "space=r in the base state" in PDEExplorer.from_state("pde=u_t = u_rr").verdict
    assert PDEExplorer.from_state("pde=u_t = u_rr,at=space=r").verdict.startswith("Well posed")
    assert PDEExplorer.from_state("pde=u_t = (f(u))_xx,at=u=0 f=u^3-u,uniform=yes").verdict.startswith("Ill posed")


@pytest.mark.slow
@every
def test_a_snapshot_says_what_it_shows(explorer):
    still = explorer.snapshot()
    data = still._repr_mimebundle_()
    assert still.verdict == explorer().verdict
    assert still.verdict in data["text/plain"]
    assert f'alt="{html.escape(still.verdict)}"' in data["text/html"]
    assert pixels(still.png).shape[1] > 700


@pytest.mark.slow
@every
def test_a_snapshot_of_an_explorer_starts_from_where_it_is(explorer):
    shown = explorer.from_state(list(explorer.presets.values())[-1])
    still = shown.snapshot()
    assert (still.state, still.verdict) == (shown.state, shown.verdict)
    control = next(c for c in explorer.controls if isinstance(c, Number))
    moved = shown.snapshot(**{control.name: control.high})
    assert moved.state == explorer(**shown.values | {control.name: control.high}).state
    assert shown.state == still.state  # nothing moved


@every
def test_an_explorer_is_had_from_the_view(explorer):
    assert getattr(primer.view, explorer.__name__) is explorer
    assert explorer.__name__ in dir(primer.view)
    with pytest.raises(AttributeError, match="has no attribute 'Nonsense'"):
        _ = primer.view.Nonsense


@every
def test_a_state_says_each_thing_once(explorer):
    state = explorer().state
    with pytest.raises(ValueError, match=f"state must say {explorer.controls[0].name} once"):
        explorer.from_state(f"{state},{state}")


@pytest.mark.slow
@every
def test_nothing_piles_up(explorer):
    steps = 500 if explorer is explorers.BaseStateExplorer else 60
    shown = explorer()
    control = next(c for c in explorer.controls if isinstance(c, Number))
    slider = shown._rows[control.name].widget.children[0]
    values = np.linspace(control.low, control.high, 26)
    values = (np.unique(np.round(values)).astype(int) if control.whole else values).tolist()

    def walk(times):
        for value in itertools.islice(itertools.cycle(values), times):
            slider.value = value
        gc.collect()
        return len(gc.get_objects())

    before = walk(60)
    assert walk(steps) - before < steps / 2  # less than one object every other step
