# Writes OUT with the commit of SOURCE, only where it changed. Where tracked files differ from the commit, "-dirty-" and a hash
# of the difference follow: two such trees are not one.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit "unknown")
endif()
if(commit MATCHES "-dirty$")
  execute_process(COMMAND git -C ${SOURCE} diff --no-ext-diff HEAD OUTPUT_VARIABLE change ERROR_QUIET)
  string(SHA1 hash "${change}")
  string(SUBSTRING ${hash} 0 8 hash)
  string(APPEND commit "-${hash}")
endif()
file(CONFIGURE OUTPUT ${OUT} CONTENT "#pragma once\n#define FARCULL_COMMIT \"${commit}\"\n")
