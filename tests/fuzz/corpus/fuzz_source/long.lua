x = param { [[
open