# What a newcomer types. Everything here works on a fresh Debian 12 (or a current Ubuntu) without a GPU, as root or through sudo.
SHELL := /bin/bash
JOBS ?= $(shell nproc)
PROGRAM := build/release/peelray
CTEST := ctest --output-on-failure --no-tests=error --parallel $(JOBS)

.PHONY: help demo build test test-long separate clean format check-format packages test-packages
.DEFAULT_GOAL := help

help:
	@echo 'make demo    install what is missing, build, render a built-in scene to out/demo.png'
	@echo 'make test    install what is missing, build, run the tests'
	@echo 'make test-long    what takes too long for that: every ray and scene, the sanitizers'
	@echo 'make separate     compile every source file by itself: each must include what it uses'
	@echo 'make build   install what is missing, build $(PROGRAM)'
	@echo 'make clean   remove build/ and out/'
	@echo 'make format  apply clang-format (check-format: only look)'

demo: build
	@mkdir -p out
	@TIMEFORMAT='out/demo.png: %R s from start to picture'; \
	time $(PROGRAM) render builtin:teapots --tracer ldc --size 1280x1024 -o out/demo.png

build: packages
	@cmake --preset release --log-level=NOTICE
	@cmake --build --preset release --parallel $(JOBS) --target peelray

test: test-packages
	@cmake --preset release --log-level=NOTICE -DPEELRAY_TESTS=ON
	@cmake --build --preset release --parallel $(JOBS) --target tests
	$(CTEST) --test-dir build/release -LE long

test-long: test-packages
	@cmake --preset release --log-level=NOTICE -DPEELRAY_TESTS=ON
	@cmake --build --preset release --parallel $(JOBS)
	$(CTEST) --test-dir build/release -L long
	@echo '== the CPU-side tests once more, under the address and undefined-behaviour sanitizers'
	@cmake --preset sanitize --log-level=NOTICE -DPEELRAY_TESTS=ON
	@cmake --build --preset sanitize --parallel $(JOBS) --target tests
	$(CTEST) --test-dir build/sanitize -L cpu

separate: packages
	@cmake --preset separate --log-level=NOTICE -DPEELRAY_TESTS=OFF
	@cmake --build --preset separate --parallel $(JOBS)

packages:
	@scripts/packages.sh packages.txt

test-packages:
	@scripts/packages.sh packages.txt test

clean:
	rm -rf build out

SOURCES = $$(git ls-files --cached --others --exclude-standard -- 'src/*.cpp' 'src/*.h' 'tests/*.cpp' 'tests/*.h' 'include/*.h' 'bench/*.cpp')

format:
	@command -v clang-format > /dev/null || { echo 'make format needs clang-format: apt-get install clang-format' >&2; exit 1; }
	clang-format -i $(SOURCES)

check-format:
	@command -v clang-format > /dev/null || { echo 'make check-format needs clang-format: apt-get install clang-format' >&2; exit 1; }
	clang-format --dry-run --Werror $(SOURCES)
