"""Colours, spectra, the models of `tyndall probe`, and tables."""
import json

import numpy as np
import pytest

import tyndall
from test_atmosphere import QUERIES, columns, probe

SHORT = QUERIES[:3]


@pytest.fixture(scope="module")
def measured(small):
    """An atmosphere whose coefficients are known at all wavelengths."""
    return {**small, "atmosphere.aerosol_optical_depth": 0.1, "atmosphere.angstrom_exponent": 1.3, "atmosphere.ozone_du": 300,
            "atmosphere.pressure_hpa": 1013, "planet.ground_albedo": 0.2}


@pytest.fixture(scope="module")
def single_xyz():
    return tyndall.Atmosphere(model="single", color="xyz")


@pytest.mark.parametrize("model", ["precomputed", "single"])
def test_colours_are_those_of_probe(model, run, tmp_path, small):
    parameters = {**small, "scattering.color": "spectral"}
    queries = tmp_path / "queries.csv"
    queries.write_text("altitude_m,view_zenith_deg,sun_zenith_deg,azimuth_deg\n" +
                       "".join(",".join(map(str, row)) + "\n" for row in SHORT))
    table = run("probe", "--queries", queries, "--model", model, "--json",
                *[word for key, value in parameters.items() for word in ("--set", f"{key}={value}")])
    rgb, transmittance, xyz = (np.array([row[name] for row in json.loads(table)["answers"]]) for name in ("L", "T", "XYZ"))
    c = {key: value[:3] for key, value in columns().items()}
    air = tyndall.Atmosphere(parameters, model=model)
    assert air.color == "rgb" and np.array_equal(air.radiance(**c), rgb)
    assert np.array_equal(air.transmittance(c["zenith"], c["altitude"]), transmittance)
    assert np.array_equal(tyndall.Atmosphere(parameters, model=model, color="xyz").radiance(**c), xyz)


@pytest.mark.parametrize("model", ["oneil", "oneil-table", "homogeneous", "homogeneous-medium"])
def test_models_are_those_of_probe(model, run, tmp_path):
    light, transmittance = probe(run, tmp_path, QUERIES, {}, "--model", model)
    sky, sun = probe(run, tmp_path, [(0, "sky", 50, 0)], {}, "--model", model)
    air = tyndall.Atmosphere(model=model)
    c = columns()
    assert np.array_equal(air.radiance(**c), light)
    assert np.array_equal(air.transmittance(c["zenith"], c["altitude"]), transmittance)
    assert np.array_equal(air.sky_irradiance([50]), sky) and np.array_equal(air.sun_irradiance([50]), sun)
    assert air.device.startswith("CPU")
    with pytest.raises(ValueError, match="whole rays"):
        air.aerial_perspective([0, 0, 0], [0, 9, 0], 30, 0)


def test_the_colour_is_that_of_the_path_tracer(single_xyz, run, tmp_path):
    c = {key: value[:3] for key, value in columns().items()}
    traced = single_xyz.trace(**c, samples=3000, orders=1)
    assert single_xyz.radiance(**c) == pytest.approx(traced.value, rel=0.02)
    rgb, _ = probe(run, tmp_path, SHORT, {"scattering.color": "spectral"}, "--model", "reference", "--samples", 3000, "--orders", 1)
    same = tyndall.Atmosphere(model="single", color="rgb").trace(**c, samples=3000, orders=1)
    assert np.array_equal(same.value, rgb)
    assert tyndall.xyz_from_rgb(same.value) == pytest.approx(traced.value, rel=1e-5)
    assert tyndall.rgb_from_xyz(traced.value) == pytest.approx(same.value, rel=1e-4)


# A spectrum at the wavelengths of the channels is the channels, and one at 40 wavelengths has the colour of four.
def test_spectra(measured, single_xyz):
    nm = [680, 550, 440]
    three = tyndall.Atmosphere(measured, wavelengths=nm)
    channels = tyndall.Atmosphere(measured)
    assert three.radiance([30, 80], 60, 40) == pytest.approx(channels.radiance([30, 80], 60, 40), rel=1e-4)
    assert three.sky_irradiance(60) == pytest.approx(channels.sky_irradiance(60), rel=1e-4)
    wavelengths, weights = tyndall.visible_spectrum()
    spectrum = tyndall.Atmosphere(model="single", wavelengths=wavelengths)
    assert spectrum.radiance(np.zeros((2, 1)), 60).shape == (2, 1, 40)
    assert np.array_equal(spectrum.wavelengths, wavelengths)
    rays = {"zenith": [20, 70], "sun_zenith": 60, "azimuth": 60}
    assert spectrum.radiance(**rays) @ weights == pytest.approx(single_xyz.radiance(**rays), rel=0.01)
    assert spectrum.sun_irradiance([40, 80]) @ weights == pytest.approx(single_xyz.sun_irradiance([40, 80]), rel=0.01)
    path = ([0, 500, 0], [9000, 900, -18000], 20, 80)
    mine, colour = spectrum.aerial_perspective(*path), single_xyz.aerial_perspective(*path)
    assert mine.inscattering @ weights == pytest.approx(colour.inscattering, rel=0.01)
    assert mine.transmittance @ weights / weights.sum(axis=0) == pytest.approx(colour.transmittance, rel=0.01)


def test_the_path_tracer_follows_spectra():
    nm = np.linspace(400, 700, 43)
    air = tyndall.Atmosphere(model="single", wavelengths=nm)
    traced = air.trace([30, 70], 50, 60, samples=2000, orders=1)
    assert traced.value.shape == traced.standard_error.shape == (2, 43)
    assert np.all(np.abs(traced.value - air.radiance([30, 70], 50, 60)) < 5.0 * traced.standard_error + 1e-5)
    sky = air.trace_sky_irradiance(50, samples=2000, orders=1)
    assert np.all(np.abs(sky.value - air.sky_irradiance(50)) < 5.0 * sky.standard_error)


@pytest.mark.parametrize("arguments, words", [
    ({"color": "cmyk"}, "channels, rgb, xyz"),
    ({"color": "rgb", "wavelengths": [500]}, "one of them"),
    ({"wavelengths": [[500]]}, "shape"),
    ({"wavelengths": [5]}, "100 to 4000"),
    ({"wavelengths": [900], "parameters": {"atmosphere.ozone_du": 300}}, "ozone_du"),
    ({"wavelengths": [500], "parameters": {"scattering.color": "spectral"}}, "scattering.color"),
    ({"model": "oneil", "color": "xyz"}, "three channels"),
    ({"parameters": {"scattering.medium": "homogeneous"}}, "homogeneous-medium"),
    ({"parameters": {"scattering.model": "oneil"}}, "model='oneil'"),
    ({"parameters": "rayleigh"}, "dictionary"),
])
def test_contradictions_are_refused(arguments, words):
    with pytest.raises(ValueError, match=words):
        tyndall.Atmosphere(**{"model": "single", **arguments})


# Entries of the tables times the phase function are what integration gives for their geometry.
def test_tables(small):
    pure = {**small, "atmosphere.aerosol_density": 0}
    tables = tyndall.Atmosphere(pure).tables()
    assert tables.high_orders.shape == tables.single_mie.shape == tables.single_rayleigh.shape == (8, 16, 16, 4, 3)
    assert tables.view_zenith.shape == tables.mean_distance.shape == tables.ends_on_ground.shape == (8, 16)
    assert tables.sun_transmittance.shape == tables.light_sun_zenith.shape + (3,)
    single = tyndall.Atmosphere(pure, model="single")
    radius = float(single.parameters["planet.radius_m"])
    a, v, s, n = (x.ravel() for x in np.meshgrid(range(8), range(16), range(16), range(4), indexing="ij"))
    h, mean, angle = tables.altitude[a], tables.mean_distance[a, v], np.cos(np.radians(tables.view_sun[n]))
    view = np.cos(np.radians(tables.view_zenith[a, v]))
    far = np.sqrt((radius + h) ** 2 + mean ** 2 + 2.0 * (radius + h) * mean * view)
    sun = (far * np.cos(np.radians(tables.sun_zenith[s])) - mean * angle) / (radius + h)
    across = np.sqrt(np.maximum(1.0 - view * view, 0.0) * np.maximum(1.0 - sun * sun, 0.0))
    # Compare by day only, because tables are coarse near sunset. Leave out rays along the horizon: rounding decides
    # whether they end on the ground.
    horizon = 180.0 - np.degrees(np.arcsin(np.minimum(radius / (radius + h), 1.0)))
    day = (h >= 0.0) & (sun > 0.1) & (across > 0.05) & (abs(angle - view * sun) < 0.98 * across)
    day &= abs(tables.view_zenith[a, v] - horizon) > 1e-3
    a, v, s, n, h, angle, view, sun, across = (x[day] for x in (a, v, s, n, h, angle, view, sun, across))
    assert a.size > 200
    azimuth = np.degrees(np.arccos((angle - view * sun) / across))
    light = single.radiance(tables.view_zenith[a, v], np.degrees(np.arccos(sun)), azimuth, h)
    phase = 3.0 / (16.0 * np.pi) * (1.0 + angle * angle)
    assert tables.single_rayleigh[a, v, s, n] * phase[:, None] == pytest.approx(light, rel=0.01, abs=1e-7)
    assert np.all(tables.single_mie == 0.0)
    i, k = np.nonzero(tables.light_sun_zenith < 80.0)
    i, k = i[::len(i) // 20], k[::len(k) // 20]
    direct = single.sun_irradiance(tables.light_sun_zenith[i, k], tables.light_altitude[i])
    assert tables.sun_transmittance[i, k] == pytest.approx(direct, abs=2e-3)
    with pytest.raises(ValueError, match="tables"):
        single.tables()
    five = tyndall.Atmosphere(pure, wavelengths=[400, 450, 500, 600, 700]).tables()
    assert five.high_orders.shape == (8, 16, 16, 4, 5)
    noon = np.argmin(five.light_sun_zenith[-1])
    assert np.all(np.diff(five.sky_irradiance[len(five.light_altitude) // 2, noon]) < 0.0)
