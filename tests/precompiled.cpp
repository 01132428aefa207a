// One file that is compiled makes what is precompiled.
