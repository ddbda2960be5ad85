# The commands of the project; `make` alone lists them. The steps themselves are CMake presets (CMakePresets.json).
.DEFAULT_GOAL := help
.PHONY: help packages test-packages build assess test check bench nightly format tidy asan tsan clean

mission := plato
astroid := build/release/bin/astroid

help: ## list these commands
	@sed -n 's/^\([a-z][a-z-]*\):[^#]*## \(.*\)/\1\t\2/p' $(MAKEFILE_LIST) | expand -t 16

packages: ## install the Debian packages that building and running need
	@cmake/install-packages.sh cmake/packages.txt

test-packages: ## install those of the test suite as well
	@cmake/install-packages.sh cmake/packages.txt cmake/packages-test.txt

build: packages ## build the program as a user runs it: build/release/bin/astroid
	cmake --preset release
	cmake --build --preset release

assess: build ## set everything up and assess a mission on a real field (mission=plato); the report goes to out/
	$(astroid) assess apps/missions/$(mission).xml -o out/$(mission) --overwrite

test: test-packages ## everything that continuous integration checks: format, warnings, clang-tidy, all tests
	cmake --workflow --preset ci

check: test-packages ## the same steps on the developer's build, before a commit
	cmake --workflow --preset check

bench: test-packages ## build and run the benchmarks, some ten minutes; results as JSON in out/bench/
	cmake --preset bench
	cmake --build --preset bench
	cmake --build --preset bench --target run-benchmarks
	@echo "results: out/bench/all.json; docs/performance.md has a run to compare with"

nightly: test-packages ## a million random cases of every property, others each time; some minutes
	cmake --preset ci && cmake --build --preset ci --target stability_core_test
	RC_PARAMS="max_success=1000000" build/ci/tests/stability/core/stability_core_test --gtest_filter='*Properties*'

format: ## format every source file
	cmake/format.sh --fix

tidy: test-packages ## clang-tidy over the tree
	cmake/tidy.py

asan: test-packages ## the tests under the address and undefined-behaviour sanitizers
	cmake --preset asan && cmake --build --preset asan && ctest --preset asan

tsan: test-packages ## the tests under the thread sanitizer
	cmake --preset tsan && cmake --build --preset tsan && ctest --preset tsan

clean: ## remove everything that was built (results in out/ stay)
	rm -rf build
