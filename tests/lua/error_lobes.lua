-- expect error: error_lobes.lua:3: march: uniform 'lobe_anisotropies' is 2; accepted: -0.95 to 0.95
local fx = effect { name = "lobes" }
fx.output = march { density = sphere {}, lobes = { {1, 2} } }
