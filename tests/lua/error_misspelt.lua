-- expect error: error_misspelt.lua:3: effect: unknown key 'fsp'; did you mean 'fps'?
local name = "misspelt"
local fx = effect { name = name, fsp = 24 }
fx.output = geometry {}
