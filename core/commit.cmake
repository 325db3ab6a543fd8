# Writes the commit of SOURCE to OUT, unless OUT has it already. If tracked files differ from the commit, "-dirty-" and a hash of
# the difference follow, so that different trees have different names. Differences in docs/results are ignored: writing a page of
# results must not change the commit of later results.
execute_process(COMMAND git -C ${SOURCE} describe --always --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(commit)
  execute_process(COMMAND git -C ${SOURCE} diff --no-ext-diff HEAD -- . ":(exclude)docs/results"
                  OUTPUT_VARIABLE change ERROR_QUIET)
  if(change)
    string(SHA1 hash "${change}")
    string(SUBSTRING ${hash} 0 8 hash)
    string(APPEND commit "-dirty-${hash}")
  endif()
else()
  set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once\n#define FARCULL_COMMIT \"${commit}\"\n")

# Also writes PROBED: a hash of the sources of kernels, probes and the code that runs them. A verdict on a device depends on them.
if(PROBED)
  file(GLOB probed ${SOURCE}/core/gl/* ${SOURCE}/core/gl/*/* ${SOURCE}/core/base/glsl_* ${SOURCE}/core/base/random.h
       ${SOURCE}/core/base/floating_point.* ${SOURCE}/core/view/budget.* ${SOURCE}/core/view/view.*
       ${SOURCE}/core/canvas/* ${SOURCE}/offsets/* ${SOURCE}/verify/kernel_* ${SOURCE}/verify/solid_lines.h
       ${SOURCE}/verify/rational.h ${SOURCE}/experiments/method/device_verdict*)
  list(SORT probed)
  set(hashes "")
  foreach(file IN LISTS probed)
    if(IS_DIRECTORY ${file})
      continue()
    endif()
    file(SHA256 ${file} hash)
    file(RELATIVE_PATH name ${SOURCE} ${file})
    string(APPEND hashes "${name} ${hash}\n")
  endforeach()
  string(SHA256 hash "${hashes}")
  string(SUBSTRING ${hash} 0 16 hash)
  file(CONFIGURE OUTPUT ${PROBED} CONTENT "#pragma once\n#define FARCULL_PROBED \"${hash}\"\n")
endif()
