# objects.mk - what several tests compile, made once: the core in every way there is, and as one file
#
# make -f tests/objects.mk OUT=folder, in the root of the sources. OUT keeps objects for the next time. Targets:
# WAY.out, what tests/bits/bits.c prints with the core built that way; gcc-avx2, whose objects have beside them what
# the compiler says of loops (.vec); core.o, the core as README's programs have it.
# LIBRARY, SANITIZED: libasperity.a as it is, and with sanitizers, instead of objects of their own.

OUT = out
strict = -std=c11 -fno-math-errno -fno-trapping-math -ffp-contract=off -Iinclude -Isrc
sanitize = -fsanitize=address,undefined -fno-sanitize-recover=all
core := $(sort $(wildcard src/core/*.c src/ndf/*.c src/bsdf/*.c))
bits := tests/bits/bits.c

.DELETE_ON_ERROR:

$(OUT)/core.o: src/asperity_core.c tests/objects.mk
	@mkdir -p $(@D)
	cc -O2 -Wall -Wextra -Wpedantic -Werror -Iinclude -Isrc -MMD -MP -c $< -o $@

# way NAME,COMPILER AND FLAGS,LIBRARY,LOOPS: its objects and its program; a report on loops, to which gcc would
# append
define way
$(OUT)/$(1)/%.o: %.c tests/objects.mk
	@mkdir -p $$(@D)
	$(if $(4),@rm -f $$(@:.o=.vec))
	$(2) $(strict) $(if $(4),-fopt-info-vec-optimized=$$(@:.o=.vec)) -MMD -MP -c $$< -o $$@
$(OUT)/$(1).program: $(patsubst %.c,$(OUT)/$(1)/%.o,$(bits) $(if $(3),,$(core))) $(3)
	$(2) $$(LDFLAGS) $$^ -lm -o $$@
objects += $(patsubst %.c,$(OUT)/$(1)/%.o,$(bits) $(core))
endef

$(eval $(call way,gcc-clones,gcc -O3))
$(eval $(call way,library,gcc -O3,$(LIBRARY)))
$(eval $(call way,gcc-o1-sanitized,gcc -O1 $(sanitize) -DASP_NO_CLONES,$(SANITIZED)))
$(eval $(call way,gcc-o0,gcc -O0 -DASP_NO_CLONES))
$(eval $(call way,gcc-avx2,gcc -O3 -mavx2 -mfma -DASP_NO_CLONES,,loops))
$(eval $(call way,gcc-avx512,gcc -O3 -mavx512f -mfma -DASP_NO_CLONES))
$(eval $(call way,clang-clones,clang -O3))
$(eval $(call way,clang-sse2,clang -O3 -DASP_NO_CLONES))
$(eval $(call way,clang-avx512,clang -O3 -mavx512f -mfma -DASP_NO_CLONES))
# Batches keep their blocks on the stack, and the linker gives WASM 64 KB of it unless told.
to_wasm = clang --target=wasm32-wasi -O3
stack = -Wl,-z,stack-size=1048576 -Wl,--stack-first
$(eval $(call way,wasm,$(to_wasm)))
$(eval $(call way,wasm-simd,$(to_wasm) -msimd128))
$(OUT)/wasm.program $(OUT)/wasm-simd.program: LDFLAGS = $(stack)

.PHONY: gcc-avx2
gcc-avx2: $(patsubst %.c,$(OUT)/gcc-avx2/%.o,$(core))

$(OUT)/wasm.out $(OUT)/wasm-simd.out: %.out: %.program
	node --no-warnings tests/bits/run-wasm.mjs $< >$@ 2>&1 || echo "exit status $$?" >>$@
$(OUT)/%.out: $(OUT)/%.program
	$< >$@ 2>&1 || echo "exit status $$?" >>$@

-include $(wildcard $(objects:.o=.d) $(OUT)/core.d)
