# The two commands. Everything else is CMake: see CONTRIBUTING.md.
#   make demo            installs what is missing, builds the program, renders the demo scene to out/demo.png
#   make check           installs what is missing, checks the formatting, builds everything with warnings as errors, runs
#                        clang-tidy on changed files, some tests with sanitizers, and every test
#   make doxygen         writes the reference of the public headers to build/doxygen/html
#   make pictures        renders the pictures of the documentation
#   make accuracy        measures the numbers of docs/accuracy.md
#   make epipolar-study  installs Pillow and matplotlib; makes the numbers, plots and pictures of docs/epipolar.md
#   make froxel-study    measures the froxel volume, docs/generated/froxels.md
#   make models-study    measures and renders what docs/models.md and docs/oneil.md show
#   make bundle          packs a portable program, out/tyndall-VERSION-linux-x86_64.tar.xz
#   make bundle-chroot   runs the bundle in a bare Debian system
#   make packages        builds Debian packages in out/debian: libtyndall0, libtyndall-dev, tyndall, python3-tyndall
#   make packages-check  checks them with lintian, and installs, runs and removes them in a root folder
#   make first-figure    installs the package of Python in a bare Debian system, and runs the first example there
#   make wheel-check     builds a wheel of the Python package with pip, installs it and uses it
#   make abi             renews the record of the binary interface of the C functions, tests/package/tyndall.abi
#   make python-figures  makes the figures of docs/python.md
#   make python-comparison  writes docs/generated/comparison.md: published data against the Python package
#   make site            builds the documentation as a site in build/site, and checks its links
#   make site-check      opens the site in Chromium and searches it
#   make passes          writes the list of passes, docs/generated/passes.md, with their cost
#   make costs           measures the cost of techniques and features, docs/generated/costs.md
#   make soak            changes the viewer at random for two minutes, and draws SOAK_FRAMES (10000) frames of random changes
#                        with the validation layer, on both CPU drivers, and without it for memory
#   make second-driver   runs every GPU test and the examples on SwiftShader
#   make fuzz            runs every fuzzer for FUZZ_SECONDS (60) and goes on where the last run ended; FUZZ names some of them
#   make interruptions   interrupts the program at INTERRUPTIONS (200) random moments, and checks what is left
#   make malformed       gives every verb MALFORMED (150) malformed files of each kind that it reads, and checks how it ends
#   make slurm-test      installs Slurm and GNU parallel, and runs the commands of docs/batch.md with them
#   make phase-limits    measures the errors of narrow phase functions, docs/generated/phase.md
#   make twilight        writes the table of illuminances by the sun's elevation, docs/generated/twilight.md
.PHONY: fuzz soak interruptions malformed slurm-test python-figures demo check doxygen pictures accuracy epipolar-study models-study twilight bundle bundle-chroot packages packages-check wheel-check python-comparison site site-check abi passes setup build format format-check tidy tidy-check tidy-all sanitize-short sanitize clean

PRESET ?= release
# The CPU device that computes the values that `tyndall report` compares other devices with.
REFERENCE_DEVICE ?= llvmpipe
SITE_PACKAGES = python3-sphinx python3-myst-parser python3-breathe python3-sphinx-rtd-theme
CLANG_PACKAGES = clang clang-tidy clang-format libclang-rt-dev llvm
OPERATORS = exponential reinhard reinhard-modified uncharted2 filmic-alu logarithmic adaptive-logarithmic agx pbr-neutral exponential-channels

demo: PRESET = release
demo: TARGETS = tyndall
demo: build
	@mkdir -p out
	@build/release/bin/tyndall render scenes/demo.toml -o out/demo.png
	@echo "The picture is at out/demo.png"

# The fast checks come first, so that they fail first.
check: PRESET = ci
check: PACKAGES = $(CLANG_PACKAGES) lintian
check: setup format-check build tidy-check sanitize-short
	@tools/second_driver.sh build/second_driver
	@ctest --preset ci --no-tests=error -j "$$(nproc)"

# The reference of the public headers, in build/doxygen/html.
doxygen:
	@tools/setup.sh
	@mkdir -p build
	@doxygen Doxyfile

pictures: PRESET = release
pictures: TARGETS = tyndall clouds spheres
pictures: build
	@mkdir -p docs/images
	@for scene in demo noon stratosphere hall; do \
	  build/release/bin/tyndall render scenes/$$scene.toml --size 640x360 -o docs/images/$$scene.png || exit 1; \
	done
	@while read -r name sun yaw exposure; do \
	  build/release/bin/tyndall render scenes/twilight.toml --size 480x270 --set sun.elevation_deg=$$sun \
	    --set camera.yaw_deg=$$yaw --set tonemap.exposure=$$exposure -o docs/images/$$name.png < /dev/null || exit 1; \
	done < scenes/twilight_pictures.txt
	@for operator in $(OPERATORS); do \
	  build/release/bin/tyndall render scenes/demo.toml --size 256x144 --set tonemap.operator=$$operator \
	    --set tonemap.auto_exposure=true -o docs/images/tonemap_$$operator.png || exit 1; \
	done
	@build/release/bin/tyndall render scenes/flythrough.toml --size 256x144 --frames 9 --time-step 7.5 \
	  -o docs/images/flythrough_%d.png
	@tools/air_pictures.sh build/release/bin/tyndall docs/images
	@cmake --build build/release --target tonemap_curves
	@build/release/bin/tonemap_curves docs/images/tonemap_curves.svg
	@tools/setup.sh python3-pil
	@build/release/bin/clouds build/clouds
	@build/release/bin/spheres build/sky_probe_spheres.ppm
	@for name in clouds clouds_without sky_probe_spheres; do \
	  /usr/bin/python3 -c "from PIL import Image; Image.open('build/$$name.ppm').save('docs/images/$$name.png', optimize=True)" || exit 1; \
	done

# The numbers of docs/accuracy.md.
accuracy: PRESET = release
accuracy: build
	@build/release/bin/tyndall validate --markdown docs/generated/accuracy.md
	@cmake --build build/release --target published_tables
	@build/release/bin/published_tables > docs/generated/published.md

# SECTIONS chooses among sweeps, pixels, tree, presets and pictures. Uses the Python of Debian, like the packages it needs.
epipolar-study: PRESET = release
epipolar-study: build
	@tools/setup.sh python3-pil python3-matplotlib
	@/usr/bin/python3 tools/epipolar_study.py build/release/bin/tyndall $(SECTIONS)

# The comparison of the froxel volume with epipolar sampling.
.PHONY: froxel-study
froxel-study: PRESET = release
froxel-study: build
	@python3 tools/froxel_study.py build/release/bin/tyndall

# The numbers and pictures of docs/models.md, and the pictures of docs/oneil.md. PARTS chooses among pictures, times, errors.
models-study: PRESET = release
models-study: build
	@tools/setup.sh python3-pil
	@/usr/bin/python3 tools/models_study.py build/release/bin/tyndall $(PARTS)
	@for figure in a b c; do \
	  build/release/bin/tyndall render scenes/figure_12$$figure.toml --size 480x270 -o docs/images/figure_12$$figure.png || exit 1; \
	done
	@for planet in demo_planet earth earth_space mars titan; do \
	  build/release/bin/tyndall render scenes/oneil/$$planet.toml --size 640x360 -o docs/images/oneil_$$planet.png || exit 1; \
	done

# The figures of docs/python.md.
python-figures: PRESET = release
python-figures: TARGETS = tyndall_python
python-figures: build
	@for script in illuminance twilight_zenith clear_sky visibility limb model_errors; do \
	  PYTHONPATH=build/release/python /usr/bin/python3 -B examples/python/$$script.py -o docs/images/python_$$script.png || exit 1; \
	done

# The numbers of docs/generated/comparison.md.
python-comparison: PRESET = release
python-comparison: TARGETS = tyndall_python
python-comparison: build
	@mkdir -p build
	@PYTHONPATH=build/release/python /usr/bin/python3 -B tools/python_comparison.py > build/comparison.md
	@mv build/comparison.md docs/generated/comparison.md

# The documentation as a site, in build/site, and in a browser.
site:
	@tools/setup.sh $(SITE_PACKAGES) $(PACKAGES)
	@mkdir -p build
	@/usr/bin/python3 -B tools/site.py build/site

site-check: PACKAGES = chromium
site-check: site
	@sh tests/package/site.sh build/site build/site_check

abi: setup
	@python3 tests/package/abi.py --renew . build/abi cc

# The illuminance from noon to deep twilight, docs/generated/twilight.md.
twilight: PRESET = release
twilight: TARGETS = tyndall
twilight: build
	@tools/twilight.py build/release/bin/tyndall > docs/generated/twilight.md

# The errors of narrow phase functions against the path tracer, docs/generated/phase.md.
.PHONY: phase-limits
phase-limits: PRESET = release
phase-limits: TARGETS = tyndall
phase-limits: build
	@mkdir -p build
	@python3 tools/phase_limits.py build/release/bin/tyndall > build/phase.md
	@mv build/phase.md docs/generated/phase.md

# docs/generated/passes.md, with the costs of every mode.
passes: PRESET = release
passes: TARGETS = tyndall passes
passes: build
	@mkdir -p build/passes
	@build/release/bin/passes --modes | while read -r mode options; do \
	  build/release/bin/tyndall bench scenes/demo.toml --json --frames 3 --set camera.samples=1 $$options > build/passes/$$mode.json < /dev/null || exit 1; \
	done
	@build/release/bin/tyndall tables --json > build/passes/tables.json
	@build/release/bin/passes build/passes > docs/generated/passes.md

# docs/generated/costs.md: what techniques and features cost. Takes about five minutes on a quiet machine with two cores.
.PHONY: costs
costs: PRESET = release
costs: TARGETS = tyndall library_costs
costs: build
	@tools/costs.py build/release/bin > build/costs.md
	@mv build/costs.md docs/generated/costs.md

# The portable bundle, out/tyndall-VERSION-linux-x86_64.tar.xz.
bundle: PRESET = release
bundle: TARGETS = tyndall_bundle tyndall_bundle_view
bundle: build
	@[ build/release/bundle/share/tyndall/report/hall.exr -nt build/release/bundle/bin/tyndall ] || \
	  build/release/bundle/bin/tyndall report --reference --device "$(REFERENCE_DEVICE)"
	@tools/bundle.sh . build/release out

# Runs the bundle in a bare Debian system, build/bookworm, which debootstrap makes. Needs root.
bundle-chroot: bundle
	@tools/setup.sh debootstrap
	@tools/bundle/bookworm.sh build/bookworm
	@sh tests/package/bundle.sh "$$(ls -t out/tyndall-*-linux-x86_64.tar.xz | head -n 1)" "$$PWD" "$$PWD/build/release" "$$PWD/build/bookworm"

# Debian packages, with the folders and the hardening options of Debian.
packages: setup
	@cmake --preset release -B build/debian -D CMAKE_INSTALL_PREFIX=/usr -D TYNDALL_BUILD_TESTS=OFF \
	  -D TYNDALL_SOURCE_FOLDER= --log-level=WARNING \
	  -D CMAKE_CXX_FLAGS="$$(DEB_CXXFLAGS_MAINT_STRIP='-g -O2' dpkg-buildflags --get CXXFLAGS) $$(dpkg-buildflags --get CPPFLAGS)" \
	  -D CMAKE_EXE_LINKER_FLAGS="$$(dpkg-buildflags --get LDFLAGS)" -D CMAKE_SHARED_LINKER_FLAGS="$$(dpkg-buildflags --get LDFLAGS)"
	@cmake --build build/debian
	@rm -rf out/debian && cpack --config build/debian/CPackConfig.cmake -B out/debian && rm -rf out/debian/_CPack_Packages

packages-check: PACKAGES = lintian
packages-check: packages
	@TYNDALL_DEB_FOLDER="$(CURDIR)/out/debian" sh tests/package/debian.sh build/debian build/packages_check . \
	  "$$(sed -n 's/.*TYNDALL_VERSION_STRING "\([^"]*\)".*/\1/p' include/tyndall/version.h)" python

# A new user of Python in a bare Debian system, build/first_figure. Needs root.
.PHONY: first-figure
first-figure: PACKAGES = debootstrap
first-figure: packages
	@tools/debian/first_figure.sh build/first_figure out/debian docs/python.md

# A wheel of the Python package, in build/wheel_check, installed and used.
wheel-check: setup
	@sh tests/package/wheel.sh . build/wheel_check

setup:
	@tools/setup.sh $(PACKAGES)

build: setup
	@cmake --preset $(PRESET) --log-level=WARNING
	@cmake --build --preset $(PRESET) $(if $(TARGETS),--target $(TARGETS))

# `make format` formats the C++ and GLSL sources in place. `make format-check` fails if a source is not formatted.
SOURCES = git ls-files '*.c' '*.cpp' '*.hpp' '*.h' '*.inl' '*.glsl' '*.comp' '*.frag' '*.vert'

format: PACKAGES = clang-format
format: setup
	@$(SOURCES) | xargs clang-format -i

format-check: PACKAGES = clang-format
format-check: setup
	@$(SOURCES) | xargs clang-format --dry-run --Werror

# `make tidy` runs clang-tidy over the files that the ledger of clean files (tools/tidy/clean.txt) does not cover, and updates
# the ledger. `make tidy-all` checks everything, adds the slow checks, among them the static analyser, and ignores the ledger.
TIDY_FOLDERS = apps examples include python shaders src tests tools
TIDY_SLOW = clang-analyzer-*,bugprone-branch-clone,bugprone-unchecked-optional-access,performance-unnecessary-value-param,misc-unused-parameters

tidy tidy-all: PRESET = ci
tidy tidy-all: PACKAGES = $(CLANG_PACKAGES)
tidy: build
	@tools/tidy.py build/release --update $(TIDY_FOLDERS)

tidy-check: build
	@tools/tidy.py build/release $(TIDY_FOLDERS)

tidy-all: build
	@tools/tidy.py build/release --all --checks '$(TIDY_SLOW)' $(TIDY_FOLDERS)

# Builds with clang, warnings as errors, and its sanitizers, and runs the tests: as `make sanitize` all of them; as
# `make sanitize-short` those with the label "sanitizers" or, for the thread sanitizer, "threads". Both copy the embedded
# shaders from the release build.
sanitize-short sanitize: PRESET = ci
sanitize-short sanitize: PACKAGES = $(CLANG_PACKAGES)
sanitize: SANITIZE_ALL = 1
sanitize-short sanitize: build
	@for run in asan-ubsan/sanitizers tsan/threads; do \
	  preset=$${run%/*}; label=$${run#*/}; \
	  cmake --preset $$preset -D TYNDALL_SHADERS_FROM="$(CURDIR)/build/release" --log-level=WARNING > /dev/null && \
	  cmake --build --preset $$preset $(if $(SANITIZE_ALL),,--target $$label) && \
	  ctest --preset $$preset --no-tests=error -j "$$(nproc)" $(if $(SANITIZE_ALL),,-L $$label) || exit 1; \
	done

# Runs the fuzzers and writes docs/generated/fuzzing.md. Their corpora grow in build/fuzz.
FUZZ_SECONDS ?= 60
fuzz: PRESET = ci
fuzz: PACKAGES = $(CLANG_PACKAGES)
fuzz: build
	@cmake --preset fuzz -D TYNDALL_SHADERS_FROM="$(CURDIR)/build/release" --log-level=WARNING > /dev/null
	@cmake --build --preset fuzz --target fuzzers
	@tools/fuzz.py --seconds $(FUZZ_SECONDS) --output docs/generated/fuzzing.md build/fuzz tests/fuzz/corpus $(FUZZ)

# Random use of the viewer for two minutes, and of the library on Mesa's driver and on SwiftShader.
SOAK_FRAMES ?= 10000
SOAK_SEED ?= 1
soak: PRESET = ci
soak: TARGETS = soak viewer_window_test
soak: build
	@tools/second_driver.sh build/second_driver
	@ctest --preset ci -C soak --no-tests=error -R MemoryStaysBounded -V
	@build/release/bin/soak --frames $(SOAK_FRAMES) --seed $(SOAK_SEED)
	@build/release/bin/soak --frames $(SOAK_FRAMES) --seed $(SOAK_SEED) --validation off
	@tests/gpu/second_driver.sh build/second_driver/vk_swiftshader_icd.json build/release/bin/soak --frames $(SOAK_FRAMES) --seed $(SOAK_SEED)

# SUITES chooses among the tests by a regular expression.
.PHONY: second-driver
second-driver: PRESET = ci
second-driver: build
	@tools/second_driver.sh build/second_driver
	@ctest --preset ci -C second_driver --no-tests=error -L second_driver $(if $(SUITES),-R '$(SUITES)')

# Malformed files through the command line; the fuzzers call the readers directly.
MALFORMED ?= 150
malformed: PRESET = ci
malformed: TARGETS = tyndall
malformed: build
	@/usr/bin/python3 -B tools/malformed.py build/release/bin/tyndall --count $(MALFORMED) --work build/malformed

# Signals at random moments of render, sky, tables, probe and validate, and at every write of the viewer while it saves.
INTERRUPTIONS ?= 200
INTERRUPTION_SEED ?= 1
interruptions: PRESET = ci
interruptions: TARGETS = tyndall viewer_saves_test
interruptions: build
	@/usr/bin/python3 -B tools/interruptions.py build/release/bin/tyndall --count $(INTERRUPTIONS) --seed $(INTERRUPTION_SEED)
	@TYNDALL_ALL_KILLS=1 build/release/bin/viewer_saves_test

# The commands of docs/batch.md with GNU parallel and a Slurm cluster of this machine, in build/slurm. Needs root.
slurm-test: PRESET = ci
slurm-test: TARGETS = tyndall
slurm-test: PACKAGES = slurm-wlm munge parallel
slurm-test: build
	@tools/slurm_test.sh build/slurm build/release/bin/tyndall

clean:
	rm -rf build out
