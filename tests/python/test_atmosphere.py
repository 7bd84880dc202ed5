"""tyndall.Atmosphere gives the numbers of `tyndall probe`, in the shapes and with the errors that it documents."""
import csv
import io
import subprocess
import sys
import threading

import numpy as np
import pytest

import tyndall

QUERIES = [(10, 60, 40, 30), (2000, 95, 70, 120), (0, 89, 85, 10), (60000, 100, 95, 170), (400000, 110, 80, 20)]


def probe(run, tmp_path, rows, parameters, *options):
    queries = tmp_path / "queries.csv"
    queries.write_text("altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n" +
                       "".join(",".join(map(str, row)) + "\n" for row in rows))
    sets = [word for key, value in parameters.items() for word in ("--set", f"{key}={value}")]
    table = csv.DictReader(io.StringIO(run("probe", "--queries", queries, *sets, *options)))
    found = list(table)
    return [np.array([[float(row[f"{name}_{c}"]) for c in "rgb"] for row in found]) for name in "LT"]


@pytest.fixture(scope="module")
def air(small):
    return tyndall.Atmosphere(small)


@pytest.fixture(scope="module")
def single():
    return tyndall.Atmosphere(model="single")


def test_notes_on_atmospheres_beyond_the_methods(small):
    thick = {**small, "atmosphere.visibility_m": 1000, "atmosphere.single_scattering_albedo": 1}
    assert any("vertical optical depth of 4.9" in note for note in tyndall.Atmosphere(thick).notes)
    assert tyndall.Atmosphere(thick, model="single").notes == []
    high = tyndall.Atmosphere({"planet.radius_m": 10000}, model="single")
    assert any("is more than 0.16 of planet.radius_m" in note for note in high.notes)


def columns():
    altitude, zenith, sun, azimuth = np.array(QUERIES, dtype=float).T
    return {"altitude": altitude, "zenith": zenith, "sun_zenith": sun, "azimuth": azimuth}


@pytest.mark.parametrize("model", ["precomputed", "single"])
def test_radiance_is_that_of_probe(model, run, tmp_path, small):
    parameters = {**small, "planet.ground_albedo": 0.3}
    light, transmittance = probe(run, tmp_path, QUERIES, parameters, "--model", model)
    mine = tyndall.Atmosphere(parameters, model=model)
    c = columns()
    assert np.array_equal(mine.radiance(**c).astype(np.float32), light.astype(np.float32))
    found = mine.transmittance(c["zenith"], c["altitude"])
    assert np.array_equal(found.astype(np.float32), transmittance.astype(np.float32))


def test_irradiance_is_that_of_probe(air, run, tmp_path, small):
    light, sun = probe(run, tmp_path, [(0, "sky", 50, 0), (3000, "sky", 92, 0)], small)
    assert np.array_equal(air.sky_irradiance([50, 92], [0, 3000]).astype(np.float32), light.astype(np.float32))
    assert np.array_equal(air.sun_irradiance([50, 92], [0, 3000]).astype(np.float32), sun.astype(np.float32))
    assert np.all(air.sun_irradiance(120.0) == 0.0)


def test_shapes_broadcast(air):
    assert air.radiance(60, 40).shape == (3,)
    assert air.radiance(np.zeros((4, 1)), np.zeros(5)).shape == (4, 5, 3)
    assert air.radiance(np.zeros(0), 40).shape == (0, 3)
    assert air.sky_map(30, width=8, height=6).shape == (6, 8, 3)
    assert air.sky_irradiance(np.zeros((2, 2))).shape == (2, 2, 3)
    assert air.aerial_perspective(np.zeros((7, 3)), [0, 0, -1000], 30, 0).transmittance.shape == (7, 3)
    with pytest.raises(ValueError):
        air.radiance(np.zeros(4), np.zeros(5))


def test_the_sky_is_brightest_around_the_sun(single):
    sky = single.sky_map(35, 95, width=36, height=18)
    row, column = np.unravel_index(np.argmax(sky[:9].sum(axis=-1)), (9, 36))
    assert (row, column) == (5, 9)
    assert np.all(sky >= 0.0)


# At the far end of a long path there is no atmosphere left, so the path has all of the light.
def test_aerial_perspective_ends_in_the_sky(air):
    sun = (30.0, 0.0)
    far = air.aerial_perspective([0, 100, 0], [0, 500e3, -800e3], *sun)
    zenith = np.degrees(np.arctan2(800e3, 500e3 - 100))
    assert far.inscattering == pytest.approx(air.radiance(zenith, 60, 0, altitude=100, ground=False), rel=1e-4)
    assert far.transmittance == pytest.approx(air.transmittance(zenith, 100), rel=1e-4)


def test_aerial_perspective_adds_up(single):
    a, b, c = [0, 500, 0], [3000, 700, -9000], [6000, 900, -18000]
    near, rest, whole = (single.aerial_perspective(p, q, 20, 80) for p, q in ((a, b), (b, c), (a, c)))
    assert near.transmittance * rest.transmittance == pytest.approx(whole.transmittance, rel=1e-6)
    assert near.apply(rest.inscattering) == pytest.approx(whole.inscattering, rel=2e-3)
    nothing = single.aerial_perspective(a, a, 20, 80)
    assert np.all(nothing.inscattering == 0.0) and np.all(nothing.transmittance == 1.0)


# The horizon of an eye at 100 m is 36 km away: a point on the ground behind it is hidden, and one above it is not.
def test_aerial_perspective_ends_at_the_ground(single):
    ends = [[0, -y, -x] for x, y in ((30e3, 70.0), (60e3, 282.0), (60e3, -200.0), (0.0, 50.0))]
    seen = single.aerial_perspective([0, 100, 0], ends, 20, 80)
    for array in (seen.inscattering, seen.transmittance):
        assert np.array_equal(np.isnan(array).all(axis=-1), [False, True, False, False])
    through = single.aerial_perspective([0, 100, 0], [0, -12.8e6, 0], 20, 80)
    assert np.all(np.isnan(through.inscattering))
    shore = single.aerial_perspective([0, -400, 0], [2000, -410, 0], 20, 80)
    assert np.all(shore.transmittance < 1.0) and np.all(shore.inscattering > 0.0)


def test_the_path_tracer_agrees(single):
    traced = single.trace([30, 70], 50, 60, samples=20000, orders=1)
    assert traced.value.shape == traced.standard_error.shape == (2, 3)
    assert np.all(np.abs(traced.value - single.radiance([30, 70], 50, 60)) < 5.0 * traced.standard_error + 1e-5)


@pytest.mark.parametrize("call, words", [
    (lambda: tyndall.Atmosphere({"atmosphere.nonsense": 1}), "atmosphere.nonsense"),
    (lambda: tyndall.Atmosphere({"atmosphere.mie_g": 3}), "mie_g"),
    (lambda: tyndall.Atmosphere(model="o'neil"), "model"),
    (lambda: tyndall.Atmosphere(scene="missing.toml"), "missing.toml"),
    (lambda: tyndall.Atmosphere(device="no such device"), "no such device"),
    (lambda: tyndall.sun_position(91, 0, "2003-10-17T12:00Z"), "latitude"),
    (lambda: tyndall.sun_position(1, 0, "yesterday"), "yesterday"),
    (lambda: tyndall.sun_position([1, 2], 0, "2003-10-17T12:00Z"), "latitude"),
    (lambda: tyndall.moon_position(0, 361, "2003-10-17T12:00Z"), "longitude"),
    (lambda: tyndall.moon_position(0, 0, "2003-10-17T12:00"), "offset"),
    (lambda: tyndall.refraction([0, np.nan]), "elevation"),
    (lambda: tyndall.Atmosphere({"atmosphere.mie_g": "x"}, model="single"), "mie_g"),
    (lambda: tyndall.render(size=(0, 10)), "size"),
    (lambda: tyndall.render(size=5), "size"),
    (lambda: tyndall.xyz_from_rgb([1, 2]), "rgb"),
])
def test_errors_name_what_is_wrong(call, words):
    with pytest.raises((ValueError, OSError, tyndall.Error)) as raised:
        call()
    assert words in str(raised.value) and "\n" not in str(raised.value)


@pytest.mark.parametrize("arguments", [{"zenith": -1, "sun_zenith": 0}, {"zenith": 0, "sun_zenith": 181},
                                       {"zenith": np.nan, "sun_zenith": 0}, {"zenith": 0, "sun_zenith": 0, "altitude": -2e4},
                                       {"zenith": 0, "sun_zenith": 0, "azimuth": np.inf}])
def test_arguments_out_of_range(single, arguments):
    with pytest.raises(ValueError, match="expected"):
        single.radiance(**arguments)


@pytest.mark.parametrize("name, arguments, words", [
    ("radiance", ("high", 0), "zenith: invalid value 'high'; expected numbers"),
    ("radiance", (np.ma.masked_greater([10.0, 95.0], 90.0), 0), "zenith: a value is masked; expected numbers"),
    ("radiance", (1j, 0), "zenith"),
    ("radiance", ([0, 1, 2], [0, 1]), r"zenith \(3,\), sun_zenith \(2,\)"),
    ("sky_map", (91,), "sun_elevation"),
    ("sky_map", ([10, 20],), "sun_elevation"),
    ("sky_map", (10, 0, 0), "width: 0 is out of range; expected 1 to 65536"),
    ("sky_map", (10, 0, 2.5), "width"),
    ("aerial_perspective", ([0, 0], [0, 1, 0], 30, 0), r"start: invalid shape \(2,\)"),
    ("aerial_perspective", ([0, 0, np.nan], [0, 1, 0], 30, 0), "start"),
    ("aerial_perspective", (np.zeros((2, 3)), np.zeros((4, 3)), 30, 0), "shapes"),
    ("aerial_perspective", ([0, 0, 0], [0, 1, 0], 100, 0), "sun_elevation"),
])
def test_arguments_are_named(single, name, arguments, words):
    with pytest.raises(ValueError, match=words):
        getattr(single, name)(*arguments)


@pytest.mark.parametrize("options", [{"samples": 0}, {"samples": -1}, {"samples": "many"}, {"orders": 257}, {"seed": -1}])
def test_options_of_the_path_tracer(single, options):
    with pytest.raises(ValueError, match=f"{list(options)[0]}.*expected"):
        single.trace(0, 0, **options)


def test_parameters(small):
    air = tyndall.Atmosphere({**small, "atmosphere.rayleigh_scattering": np.array([5e-6, 1e-5, 3e-5]), "scattering.enabled": True})
    assert air.parameters["atmosphere.rayleigh_scattering"].split(",")[1].startswith("1e-05")
    names = {entry["name"] for entry in tyndall.parameters()}
    assert "atmosphere.mie_g" in names and all(entry["meaning"] for entry in tyndall.parameters())


def test_threads_get_the_same_numbers(air, single):
    zenith = np.linspace(0, 180, 500)
    right = [air.radiance(zenith, 60), single.radiance(zenith, 60)]
    wrong = []

    def work(model, expected):
        for _ in range(4):
            if not np.array_equal(model.radiance(zenith, 60), expected):
                wrong.append(model)

    threads = [threading.Thread(target=work, args=pair) for pair in 2 * list(zip((air, single), right))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


# In a process of its own, because no device may exist before, and a deadlock must end.
def test_threads_create_atmospheres():
    script = ("import threading, tyndall\n"
              "made = []\n"
              "def work(): made.append(tyndall.Atmosphere(model='single').radiance(30, 60))\n"
              "threads = [threading.Thread(target=work) for _ in range(4)]\n"
              "[t.start() for t in threads]\n"
              "[t.join() for t in threads]\n"
              "print(len(made))\n")
    done = subprocess.run([sys.executable, "-B", "-c", script], capture_output=True, text=True, timeout=120)
    assert done.stdout == "4\n", done.stderr


def test_interrupt_ends_the_path_tracer():
    script = ("import os, signal, threading, tyndall\n"
              "air = tyndall.Atmosphere(model='single')\n"
              "threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()\n"
              "try:\n"
              "    air.trace([30] * 50, 60, samples=20000000)\n"
              "except KeyboardInterrupt:\n"
              "    print('interrupted')\n")
    done = subprocess.run([sys.executable, "-B", "-c", script], capture_output=True, text=True, timeout=120)
    assert done.stdout == "interrupted\n", done.stderr


# The example of Reda and Andreas (2003), table A5.1: topocentric zenith angle without refraction, and azimuth.
def test_sun_position():
    sun = tyndall.sun_position(39.742476, -105.1786, "2003-10-17T12:30:30-07:00", 1830.14)
    assert sun.elevation == pytest.approx(39.872046, abs=1e-3)
    assert sun.azimuth == pytest.approx(194.34024, abs=1e-3)
    assert sun.zenith == 90.0 - sun.elevation


# Meeus (1998), example 47.a: the distance on 1992-04-12 at 0h TD, which is 58 s after UT, and example 48.a: the lit fraction.
def test_moon_position():
    moon = tyndall.moon_position(0, 0, "1992-04-11T23:59:02Z")
    assert moon.distance_km == pytest.approx(368409.7, abs=40)
    assert moon.illuminated_fraction == pytest.approx(0.6786, abs=1e-3)
    assert moon.zenith == 90.0 - moon.elevation
    full = tyndall.moon_position(46.6, 7.9, "2026-01-03T23:00+01:00")  # a full moon near its perigee, high in winter
    assert full.elevation > 50 and full.illuminated_fraction > 0.99 and 0.25 < full.illuminance < 0.4
    assert 130e3 < tyndall.SUN_ILLUMINANCE < 136e3


# Saemundsson (1986): 28.98 minutes of arc at the horizon of an object without an atmosphere; 0 at the zenith.
def test_refraction():
    found = tyndall.refraction([0, 45, 90])
    assert found[0] * 60 == pytest.approx(28.98, abs=0.1)
    assert found[1] * 60 == pytest.approx(1.0, abs=0.05)
    assert found[2] * 60 == pytest.approx(0.0, abs=0.01)


def test_scenes_name_files_in_their_folder_until_it_is_allowed(tmp_path):
    (tmp_path / "a").mkdir()
    (tmp_path / "air.toml").write_text("[atmosphere]\naerosol_density = 2\n")
    (tmp_path / "a" / "scene.toml").write_text('include = ["../air.toml"]\n')
    script = ("import sys, tyndall\nif len(sys.argv) > 2: tyndall.allow_outside()\n"
              "try: tyndall.Atmosphere(scene=sys.argv[1], model='oneil'); print('read')\n"
              "except ValueError as error: print('outside' if '--allow-outside' in str(error) else error)\n")
    scene = str(tmp_path / "a" / "scene.toml")
    for arguments, words in ([scene], "outside"), ([scene, "yes"], "read"):
        done = subprocess.run([sys.executable, "-c", script] + arguments, capture_output=True, text=True)
        assert done.stdout.strip() == words, done.stderr


def test_render(scenes, small):
    picture = tyndall.render(parameters={**small, "terrain.source": "none", "camera.pitch_deg": 20}, size=(32, 18))
    assert picture.shape == (18, 32, 3) and picture.dtype == np.float32 and np.all(picture > 0.0)
    shown = tyndall.render(parameters={**small, "terrain.source": "none", "camera.pitch_deg": 20}, size=(32, 18), display=True)
    assert np.all((shown >= 0.0) & (shown <= 1.0))


# Nothing is printed, and the types of the documentation hold.
def test_silence(small, capfd):
    tyndall.Atmosphere(small).radiance(10, 20)
    captured = capfd.readouterr()
    assert captured.out == "" and captured.err == ""
    for name in tyndall.__all__:
        assert getattr(tyndall, name).__doc__
