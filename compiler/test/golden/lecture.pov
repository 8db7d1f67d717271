// lecture, exported by scc
//   povray +ITHIS.pov +OIMAGE.png +W640 +H480 +FN16 File_Gamma=1.0 -A -D
#version 3.7;

// Declare=scc_exposure=0.25 on the command line makes the picture four times darker.
#ifndef (scc_exposure) #declare scc_exposure = 1; #end
global_settings {
    assumed_gamma 1.0
    max_trace_level 5
    adc_bailout 0
    ambient_light rgb scc_exposure*0.2
}
#default { finish { ambient 0 diffuse 0 specular 0 } }
background { rgb scc_exposure*<0.014443843596092545, 0.021219010376003555, 0.0295568344378088> }

// ---- camera ----

camera {
    perspective
    location <4.0, 3.0, 6.0>
    direction <-0.5240974256643347, -0.3275608910402092, -0.7861461384965021>
    right <0.6056830811028151, 0.0, -0.40378872073521005>*image_width/image_height
    up <-0.13226539315601157, 0.6877800444112603, -0.1983980897340174>
}

// ---- per-point functions ----

#declare f_checker_step = function(x, y, z, v4) { select(abs((v4 - 2.0 * floor(v4 / 2.0)) - 0.0), 0, 1, 0) }
#declare f_checker = function(x, y, z) { f_checker_step(x, y, z, (floor(x) + floor(z))) }

// ---- materials ----

#declare m_red = texture {
    pigment { rgb <0.7, 0.1, 0.1> }
    finish { ambient rgb <0.28571428571428575, 0.19999999999999998, 0.19999999999999998> diffuse 1.0 specular 0.6 roughness 0.025 }
}
#declare m_mirror = texture { pigment { rgb 0.05 } finish { ambient rgb 1.0 diffuse 1.0 reflection { rgb 0.8 } } }
#declare m_inside = texture { pigment { rgb <0.1, 0.2, 0.6> } finish { ambient rgb 1.0 diffuse 1.0 } }
#declare m_plane = texture {
    pigment { function { f_checker(x, y, z) } color_map { [0 rgb 0.1] [1 rgb 0.8] } }
    finish { ambient rgb 1.0 diffuse 1.0 }
}

// ---- objects ----

// sphere
sphere {
    <0.0, 0.0, 0.0>, 1.0
    texture { m_red }
    matrix <1.0, 0.0, 0.0,  0.0, 0.7, 0.0,  0.0, 0.0, 1.0,  0.0, 0.7, 0.0>
}
// cylinder
cylinder {
    <2.0, 0.0, 0.0>, <2.0, 1.6, 0.0>, 0.4 open
    texture { m_mirror }
    interior_texture { m_inside }
}
// plane
plane {
    <0.0, 1.0, 0.0>, 0.0
    texture { m_plane }
}

// ---- lights ----

// point_light
light_source { <4.0, 6.0, 3.0> rgb scc_exposure*0.3569836089406127 fade_distance 9.668379391020117 fade_power 1.7737058413675897 }
light_source { <4.0, 6.0, 3.0> rgb scc_exposure*-0.10925038200638593 fade_distance 14.659557949206167 fade_power 1.2877139769801784 }
light_source { <4.0, 6.0, 3.0> rgb scc_exposure*0.2415766863607755 fade_distance 7.115894813638438 fade_power 1.3031979733859473 }
light_source { <4.0, 6.0, 3.0> rgb scc_exposure*0.0002251732839329219 fade_distance 273.798727783099 fade_power 1.0859699722672145 }
// directional_light
light_source { <408248.29046386306, 816496.5809277261, 408248.29046386306> rgb scc_exposure*<0.3, 0.3, 0.35> parallel point_at 0 }
