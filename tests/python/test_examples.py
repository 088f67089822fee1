"""The pages of examples/: their structure, and their Python cells, executed on the smallest grid."""

import re
import runpy
import sys

import numpy as np
import pytest

from tests.conftest import REPOSITORY

EXAMPLES = REPOSITORY / "examples"
DKT = EXAMPLES / "drafting-kissing-tumbling"
PAGES = sorted(EXAMPLES.rglob("*.qmd"))
STEPS = 4


def cells(page):
    """Code of the executable cells of a page, in order."""
    return re.findall(
        r"^```\{python\}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )


def labels(page):
    return re.findall(r"^#\| label: (\S+)$", page.read_text(encoding="utf-8"), re.MULTILINE)


@pytest.fixture(autouse=True)
def figures_without_a_screen(monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "Agg")
    yield
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")


@pytest.fixture
def in_page_folder(monkeypatch):
    """As Quarto does; what the page imports from its folder is forgotten afterwards."""
    monkeypatch.chdir(DKT)
    monkeypatch.setattr(sys, "path", [*sys.path])
    before = set(sys.modules)
    yield
    for name in {"dkt", "figures", "report", "local_build"} & (set(sys.modules) - before):
        del sys.modules[name]


@pytest.fixture
def dkt(in_page_folder):
    sys.path.insert(0, str(DKT))
    import dkt

    return dkt


# ----------------------------------------------------------------------------------------------- the page


def test_page_tells_its_story_in_order():
    text = (DKT / "index.qmd").read_text(encoding="utf-8")
    sections = [
        "The problem",
        "Set-up in dynamic similarity",
        "Run",
        "What comes out",
        "Change this",
        "Reproduce",
        "References",
    ]
    assert re.findall(r"^## (.*)$", text, re.MULTILINE) == sections
    assert labels(DKT / "index.qmd") == [
        "setup",
        "parameters",
        "similarity",
        "run",
        "tbl-claims",
        "fig-history",
        "fig-slices",
    ]


def test_cells_run_in_order_and_make_figures_and_table(in_page_folder, monkeypatch, capsys):
    monkeypatch.setenv("DKT_RESOLUTION", "6")
    monkeypatch.setenv("DKT_STEPS", str(STEPS))
    from matplotlib import pyplot

    names = {}
    drawn = {}
    for label, code in zip(labels(DKT / "index.qmd"), cells(DKT / "index.qmd"), strict=True):
        pyplot.close("all")
        exec(compile(code, f"index.qmd: {label}", "exec"), names)
        drawn[label] = (len(pyplot.get_fignums()), capsys.readouterr().out)
    assert drawn["fig-history"][0] == drawn["fig-slices"][0] == 1
    rows = drawn["tbl-claims"][1].strip().splitlines()
    assert rows[0].count("|") == rows[2].count("|") == 5
    assert sum("peak speed" in row for row in rows) == 2
    assert "48 × 160 × 48" in drawn["similarity"][1]
    assert [len(result.time) for result in names["results"]] == [STEPS + 1] * 2


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(EXAMPLES)))
def test_links_and_site_know_the_page(page):
    inside = str(page.relative_to(EXAMPLES))
    assert f"- {inside}\n" in (EXAMPLES / "_quarto.yml").read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8")):
        assert (page.parent / target).exists(), f"{inside} links to {target}"


def test_first_example_runs(monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    text = (EXAMPLES / "index.qmd").read_text(encoding="utf-8")
    code = re.search(r"^```python\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)[1]
    names = {}
    exec(compile(code.replace("run(200)", "run(2, progress=False)"), "index.qmd", "exec"), names)
    assert (tmp_path / "drop.png").stat().st_size > 0
    assert names["simulation"].history["velocity"][-1, 0, 1] < 0


# --------------------------------------------------------------------------------------------- the command


def run_command(*arguments):
    sys.argv = ["run.py", *map(str, arguments)]
    with pytest.raises(SystemExit) as stop:
        runpy.run_path(str(DKT / "run.py"), run_name="__main__")
    return stop.value.code


def test_command_prints_and_writes(in_page_folder, monkeypatch, tmp_path, capsys):
    monkeypatch.setattr(sys, "argv", [])
    assert run_command("--resolution", 6, "--steps", 3, "--output", tmp_path, "--quiet") == 0
    assert {path.name for path in tmp_path.iterdir()} == {
        "d6-proper.csv",
        "d6-proper-vorticity.png",
        "d6-history.png",
    }
    output = capsys.readouterr().out
    for line in ("drafting from", "contact", "side by side", "peak speed of the follower", "s per step"):
        assert line in output
    header, *rows = (tmp_path / "d6-proper.csv").read_text().splitlines()
    assert header.split(",")[:3] == ["time_s", "leader_position_cm_x", "leader_position_cm_y"]
    assert len(rows) == 4
    assert len({row.count(",") for row in [header, *rows]}) == 1


@pytest.mark.parametrize(
    "wrong", [("--resolution", "7"), ("--steps", "0"), ("--contact", "soft"), ("--steps", "a")]
)
def test_command_explains_wrong_options(in_page_folder, monkeypatch, wrong, capsys):
    monkeypatch.setattr(sys, "argv", [])
    assert run_command(*wrong) == 2
    assert wrong[0] in capsys.readouterr().err


# ------------------------------------------------------------------------------------------------ the case


@pytest.mark.parametrize("resolution", [6, 8, 12, 16])
def test_every_grid_holds_the_same_physics(dkt, resolution):
    case, published = dkt.Case(resolution), dkt.Case(12)
    assert 2 * case.radius == resolution
    np.testing.assert_allclose(case.tank * case.cell_size, dkt.TANK)
    # Galileo number: gravity, size and viscosity in any units
    galileo = [np.sqrt(c.gravity * c.resolution**3) / c.viscosity for c in (case, published)]
    assert galileo[0] == pytest.approx(galileo[1], rel=1e-12)
    assert galileo[0] == pytest.approx(np.sqrt(981 / 6**3) / 0.01, rel=1e-12)
    assert case.number_of_steps * case.time_step == pytest.approx(1960 * 3.28e-4, rel=1e-3)
    distance = case.start[1] - case.start[0]
    np.testing.assert_allclose(distance * case.cell_size, [0.005 / 6, 0.34, 0], atol=1e-12)


def test_published_grid(dkt):
    case = dkt.Case(12)
    assert case.cells.tolist() == [88, 304, 88]
    assert case.tank.tolist() == [72, 288, 72]
    assert case.number_of_steps == 1960
    assert case.time_step == pytest.approx(3.28e-4)
    assert case.viscosity * dkt.TIME_STEP == pytest.approx(0.017, rel=1e-3)
    assert dkt.Case(6).cells.tolist() == [48, 160, 48]


@pytest.mark.parametrize("options", [{"resolution": 7}, {"contact": "soft"}, {"scheme": "central"}])
def test_case_refuses_what_it_does_not_know(dkt, options):
    with pytest.raises(ValueError, match=rf"{next(iter(options))}: expected one of .* found"):
        dkt.Case(**options)


def made_up_result(dkt, touch=20):
    """The follower approaches at 1 cm/s from 0.05 d above, is 10 % faster, and sticks from the touch on."""
    case = dkt.Case(6)
    time = 0.001 * np.arange(60)
    approach = np.maximum(0, 1 - np.arange(60) / touch)
    velocity = np.zeros((60, 2, 3))
    velocity[:, :, 1] = -10
    velocity[:touch, 1, 1] = -11
    position = np.zeros((60, 2, 3))
    position[:, 1, 1] = dkt.DIAMETER * (1 + 0.05 * approach)
    position[40:, 1, 0] = 0.9 * dkt.DIAMETER
    position[:, :, 1] += 2
    impulse = np.zeros((60, 2, 3))
    impulse[touch, 0, 1], impulse[touch, 1, 1] = -1, 1
    return dkt.Result(case, time, position, velocity, np.zeros_like(velocity), impulse, (), 1.0)


def test_measures_of_a_made_up_run(dkt):
    measures = dkt.measure(made_up_result(dkt))
    assert measures.drafting == pytest.approx(0.001)
    assert measures.contact == pytest.approx(0.020)
    assert measures.side_by_side == pytest.approx(0.040)
    assert (measures.peak_leader, measures.peak_follower) == (10, 11)
    np.testing.assert_allclose(measures.speeds_before_touch, [10, 11])
    np.testing.assert_allclose(measures.speeds_after_touch, [10, 10])
    assert measures.momentum_error == 0
    assert measures.largest_overlap < 1e-12


def test_what_did_not_happen_is_no_number(dkt):
    whole = made_up_result(dkt)
    names = ("time", "position", "velocity", "angular_velocity", "contact_momentum")
    short = dkt.dataclasses.replace(whole, **{name: getattr(whole, name)[:10] for name in names})
    measures = dkt.measure(short)
    assert np.isnan([measures.contact, measures.side_by_side, *measures.speeds_after_touch]).all()


def test_pages_cite_what_the_bibliography_has():
    known = set(
        re.findall(r"^@\w+\{(\w+),", (EXAMPLES / "references.bib").read_text(encoding="utf-8"), re.MULTILINE)
    )
    cited = {
        key for page in PAGES for key in re.findall(r"@([A-Z]\w+\d{4})", page.read_text(encoding="utf-8"))
    }
    assert cited <= known
    assert len(cited) >= 4
